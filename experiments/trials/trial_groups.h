#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/support/statistics.h"
#include "experiments/trials/trial_record.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// A number that every trial with a plan has.
struct TrialMetric {
  std::string name;  ///< as in results and summaries: "graph_s"
  std::string title;
  std::string unit;
  double (*value)(const TrialRecord&);  ///< of a successful trial
};

/// All metrics: times first, then properties of the plan.
const std::vector<TrialMetric>& TrialMetrics();
/// @throws std::invalid_argument if there is no metric of that name.
const TrialMetric& MetricNamed(const std::string& name);

/// The trials of one row and preset.
struct TrialGroup {
  std::string row;
  std::string preset;
  std::vector<TrialRecord> trials;

  int successes() const;
  int verified() const;
  /// Number of trials by "no" answer.
  std::map<std::string, int> answers() const;
  /// The same in words: "19 exhausted, 1 time_limit".
  std::string AnswersText() const;
  /// Values of the successful trials.
  std::vector<double> Values(const TrialMetric& metric) const;
  /// None if no trial succeeded.
  std::optional<SampleSummary> Summary(const TrialMetric& metric) const;

  /// {"row", "preset", "trials", "success", "verified" (shares), "no" (counts by answer), and per
  /// metric an object or null}.
  nlohmann::ordered_json Json() const;
};

/// Trials in the order of a results file, in groups.
std::vector<TrialGroup> GroupTrials(const std::vector<TrialRecord>& records);

/// Processors of the measurements, each once: "cpu A; cpu B".
std::string MachinesOf(const std::vector<TrialRecord>& records);

/// {"mean", "std", "median", "p95", "max"}, or null.
nlohmann::ordered_json ToJson(const std::optional<SampleSummary>& summary);

}  // namespace possibility::experiments
