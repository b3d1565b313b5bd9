#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/trials/trial_record.h"

namespace possibility::experiments {

/// Merges records of one experiment from several folders: each trial once, from the first folder
/// that has it. `parts`: file names, for messages, and their records.
/// @throws InputError if two parts have different experiments, settings, scenarios or robots, or
/// disagree about a trial (except for timings).
std::vector<TrialRecord> MergeRecords(
    const std::vector<std::pair<std::filesystem::path, std::vector<TrialRecord>>>& parts);

}  // namespace possibility::experiments
