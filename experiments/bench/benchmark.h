#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/support/statistics.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// A timed operation. `call(i)` runs it once; i counts up, so that calls can cycle through inputs.
struct BenchmarkCase {
  std::string name;
  std::function<void(int)> call;
};

struct BenchmarkRow {
  std::string name;
  double microseconds = 0;  ///< per call: median over rounds
  std::vector<double> rounds;
  /// Further figures: "success", ...
  std::vector<std::pair<std::string, double>> figures = {};
};

struct BenchmarkRatio {
  std::string name;
  double value = 0;  ///< above 1: we are faster
  std::string meaning;
};

struct BenchmarkReport {
  std::vector<BenchmarkRow> rows;
  std::vector<BenchmarkRatio> ratios;
  /// Figures that are not ratios: "cold_s_median", ...
  std::vector<std::pair<std::string, double>> figures;
  /// Figures that belong together, by name: "spatial_step".
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, double>>>> groups;

  /// {"rows": [{"name", "microseconds", and each figure}...], "ratios": {name: value...}, each
  /// figure, and each group as an object}
  nlohmann::ordered_json Json() const;
  std::string Text() const;
  /// Median over rounds of slow / fast, the two of a round measured close together. Rows by name.
  double Ratio(const std::string& slow, const std::string& fast) const;
};

/// Times the cases in turn, round after round, so that other load on the machine affects all alike.
/// In every round each case runs for about `seconds_per_batch`. Reports rounds through `progress`
/// (done, of).
std::vector<BenchmarkRow> TimeInTurn(const std::vector<BenchmarkCase>& cases, int rounds,
                                     double seconds_per_batch,
                                     const std::function<void(int, int)>& progress);

/// Throughput of two threads over that of one. `worker()` prepares one thread and returns its call.
double TwoThreadThroughput(const std::function<std::function<void(int)>()>& worker, int calls,
                           int rounds);

}  // namespace possibility::experiments
