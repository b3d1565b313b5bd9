#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/trials/trial_record.h"

namespace possibility::experiments {

/// Records of one experiment that were measured in several folders: each trial once, of the first
/// folder that has it. `parts`: file names, for messages, and their records.
/// @throws InputError if two parts are of different experiments, settings, scenarios or robots, or
/// tell the same trial differently (timings aside).
std::vector<TrialRecord> MergeRecords(
    const std::vector<std::pair<std::filesystem::path, std::vector<TrialRecord>>>& parts);

}  // namespace possibility::experiments
