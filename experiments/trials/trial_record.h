#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// Identifies a trial of an experiment: scenario row, planner preset and seed.
struct TrialKey {
  std::string row;
  std::string preset;
  std::uint64_t seed = 1;

  auto operator<=>(const TrialKey&) const = default;
};

/// Must be equal for trials that are counted together.
struct TrialIdentity {
  std::string experiment;     ///< "table", "twins", "sweep <template> <parameter>"
  std::string scenario_hash;  ///< of the scenario or template
  std::string robot_hash;
  std::string settings_hash;  ///< of the program's version and options

  bool operator==(const TrialIdentity&) const = default;
};

/// Result of one trial. Times in s.
struct TrialRecord {
  TrialKey key;
  TrialIdentity identity;
  std::string parameter;  ///< of a sweep; empty: none
  double value = 0;       ///< of the parameter

  bool success = false;
  bool verified = false;
  std::string no;  ///< if no success: "proven_infeasible", "exhausted" or "time_limit"
  actions::PlanTimings timings;
  double memory_mb = 0;  ///< the process' peak during the trial, MB; 0: unknown
  std::optional<double> real_time_ratio;
  std::map<std::string, std::int64_t> counters;
  std::string explorers;  ///< of the route's edges: "lattice, shortcuts"

  double plan_duration = 0;
  double length = 0;      ///< PlanarLength, m
  std::string plan_hash;  ///< of the plan's motion; empty: none
  std::string machine;    ///< its processor

  /// m/s; none without a plan.
  std::optional<double> speed() const;

  nlohmann::ordered_json Json() const;
  /// @throws nlohmann::json::exception if `json` is no record.
  static TrialRecord FromJson(const nlohmann::ordered_json& json);
};

/// Whether two records are equal except for times and machine.
bool SameButTimings(const TrialRecord& a, const TrialRecord& b);

/// Sorts as in a results file: rows as in `row_order`, others last; within a row by the parameter's
/// value, the preset (default first) and the seed.
void SortRecords(const std::vector<std::string>& row_order, std::vector<TrialRecord>* records);

/// Hash of everything that the execution of the plan depends on: actions, contacts and knots, exact
/// to the bit.
std::string MotionHash(const actions::Plan& plan);

}  // namespace possibility::experiments
