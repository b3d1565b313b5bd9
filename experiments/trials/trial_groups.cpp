#include "experiments/trials/trial_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

namespace possibility::experiments {

using Json = nlohmann::ordered_json;

const std::vector<TrialMetric>& TrialMetrics() {
  using Record = const TrialRecord&;
  static const std::vector<TrialMetric> metrics = {
      {"preparation_s", "Preparation", "s", [](Record r) { return r.timings.preparation_s; }},
      {"graph_s", "Graph", "s", [](Record r) { return r.timings.graph_s; }},
      {"confirmation_s", "Confirmation", "s", [](Record r) { return r.timings.confirmation_s; }},
      {"motion_s", "Motion", "s", [](Record r) { return r.timings.motion_s; }},
      {"verification_s", "Verification", "s", [](Record r) { return r.timings.verification_s; }},
      {"memory_mb", "Memory", "MB", [](Record r) { return r.memory_mb; }},
      {"plan_duration_s", "Plan duration", "s", [](Record r) { return r.plan_duration; }},
      {"real_time_ratio", "Real-time ratio", "",
       [](Record r) { return r.real_time_ratio.value_or(0); }},
      {"length_m", "Path length", "m", [](Record r) { return r.length; }},
      {"speed_m_s", "Speed", "m/s", [](Record r) { return r.speed().value_or(0); }}};
  return metrics;
}

const TrialMetric& MetricNamed(const std::string& name) {
  for (const TrialMetric& metric : TrialMetrics()) {
    if (metric.name == name) return metric;
  }
  throw std::invalid_argument("there is no metric " + name);
}

int TrialGroup::successes() const {
  return static_cast<int>(
      std::count_if(trials.begin(), trials.end(), [](const TrialRecord& r) { return r.success; }));
}

int TrialGroup::verified() const {
  return static_cast<int>(
      std::count_if(trials.begin(), trials.end(), [](const TrialRecord& r) { return r.verified; }));
}

std::map<std::string, int> TrialGroup::answers() const {
  std::map<std::string, int> counts;
  for (const TrialRecord& record : trials) {
    if (!record.success) ++counts[record.no];
  }
  return counts;
}

std::string TrialGroup::AnswersText() const {
  std::string text;
  for (const auto& [answer, count] : answers()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, answer);
  }
  return text;
}

std::vector<double> TrialGroup::Values(const TrialMetric& metric) const {
  std::vector<double> values;
  for (const TrialRecord& record : trials) {
    if (record.success) values.push_back(metric.value(record));
  }
  return values;
}

std::optional<SampleSummary> TrialGroup::Summary(const TrialMetric& metric) const {
  const std::vector<double> values = Values(metric);
  if (values.empty()) return std::nullopt;
  return Summarise(values);
}

Json TrialGroup::Json() const {
  const double count = static_cast<double>(trials.size());
  experiments::Json json;
  json["row"] = row;
  json["preset"] = preset;
  json["trials"] = trials.size();
  json["success"] = successes() / count;
  json["verified"] = verified() / count;
  json["no"] = answers();
  for (const TrialMetric& metric : TrialMetrics()) json[metric.name] = ToJson(Summary(metric));
  return json;
}

std::vector<TrialGroup> GroupTrials(const std::vector<TrialRecord>& records) {
  std::vector<TrialGroup> groups;
  for (const TrialRecord& record : records) {
    const auto& [row, preset, seed] = record.key;
    if (groups.empty() || groups.back().row != row || groups.back().preset != preset) {
      groups.push_back({row, preset, {}});
    }
    groups.back().trials.push_back(record);
  }
  return groups;
}

std::string MachinesOf(const std::vector<TrialRecord>& records) {
  std::set<std::string> machines;
  for (const TrialRecord& record : records) machines.insert(record.machine);
  std::string text;
  for (const std::string& machine : machines) text += (text.empty() ? "" : "; ") + machine;
  return text;
}

Json ToJson(const std::optional<SampleSummary>& summary) {
  if (!summary) return nullptr;
  return {{"mean", summary->mean},
          {"std", summary->std},
          {"median", summary->median},
          {"p95", summary->p95},
          {"max", summary->max}};
}

}  // namespace possibility::experiments
