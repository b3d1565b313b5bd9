#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/input/json_text.h"

namespace possibility::experiments {

/// A difference between two runs of the regression suite.
struct RegressionDifference {
  enum class Kind {
    kWorse,   ///< makes the comparison fail
    kSlower,  ///< more seconds, which also depend on other load
    kNote     ///< neither: another environment, a new problem
  };
  Kind kind = Kind::kNote;
  std::string problem;  ///< empty: the whole run
  std::string what;     ///< "status", "optimum", "error", "iterations", "seconds", ...
  std::string text;     ///< "iterations 10, now 14 (+40 %)"
};

struct RegressionComparison {
  std::vector<RegressionDifference> differences;

  /// Whether anything but seconds got worse.
  bool failed() const;
  nlohmann::ordered_json Json() const;
  std::string Text() const;
};

/// Reads a file that `possibility regress --out` wrote.
/// @throws InputError naming the file and the fault in it, unless CompareRegressions can use it.
nlohmann::json ReadRegressionFile(const std::filesystem::path& file);

/// What got worse from `old_run` to `new_run`, both in the form of RegressionReport::Json().
/// Problems of the old run that are missing in the new one count as lost if the new run is of the
/// whole suite (`is_whole`).
/// @throws InputError if either is not in that form.
RegressionComparison CompareRegressions(const nlohmann::json& old_run,
                                        const nlohmann::json& new_run, bool is_whole = true);

}  // namespace possibility::experiments
