#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/trials/trial_record.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// Result of `possibility sweep`: success and times over a parameter of a scenario.
struct SweepReport {
  std::vector<TrialRecord> trials;  ///< in the order of a results file; at least one

  /// "possibility-sweep/1" (docs/experiments.md).
  nlohmann::ordered_json Summary() const;
  /// A row per value and preset.
  std::string Csv() const;
  std::string Markdown() const;

  /// Writes summary.json, sweep.csv, success.svg, times.svg and report.html. Takes pictures of
  /// plans from the folder (PictureFile).
  /// @throws InputError if a file cannot be written.
  void Write(const std::filesystem::path& folder) const;
};

}  // namespace possibility::experiments
