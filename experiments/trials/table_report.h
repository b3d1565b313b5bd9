#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/trials/trial_record.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// Result of `possibility table`: our Table 1 beside the paper's.
struct TableReport {
  std::vector<TrialRecord> trials;  ///< in the order of a results file
  std::vector<TrialRecord> twins;   ///< of infeasible scenarios; may be empty

  /// "possibility-table/1" (docs/experiments.md).
  nlohmann::ordered_json Summary() const;
  std::string Markdown() const;

  /// Writes summary.json, table.md, report.html and the plots. Takes pictures of plans from the
  /// folder (PictureFile).
  /// @throws InputError if a file cannot be written.
  void Write(const std::filesystem::path& folder) const;
};

/// Names of all rows, including twins, in the order of results files.
std::vector<std::string> TableRowOrder();

}  // namespace possibility::experiments
