#pragma once

#include <string>
#include <vector>

#include "experiments/trials/trial_record.h"

namespace possibility::experiments::testing {

/// A trial of the table that succeeded; times depend on the seed.
inline TrialRecord SampleRecord(const std::string& row, const std::string& preset,
                                std::uint64_t seed) {
  TrialRecord record;
  record.key = {row, preset, seed};
  record.identity = {"table", "scenario of " + row, "robot", "settings"};
  record.success = record.verified = true;
  const double s = static_cast<double>(seed);
  record.timings = {0.5, 0.1 * s, 0.05 * s, 0.25, 2.0 / 3};
  record.real_time_ratio = 100 / (0.75 + 0.1 * s);
  record.counters = {{"cycles", static_cast<std::int64_t>(10 * seed)}, {"jobs failed", 0}};
  record.plan_duration = 100;
  record.length = 1.0 / 3 * s;
  record.plan_hash = "hash" + std::to_string(seed);
  record.machine = "machine \"one\"";
  return record;
}

/// A trial without a plan.
inline TrialRecord FailedRecord(const std::string& row, const std::string& preset,
                                std::uint64_t seed) {
  TrialRecord record;
  record.key = {row, preset, seed};
  record.identity = {"table", "scenario of " + row, "robot", "settings"};
  record.no = "time_limit";
  record.timings = {0.5, 59.5, 0, 0, 0};
  record.machine = "machine two";
  return record;
}

/// A trial of a sweep over "gap".
inline TrialRecord SweepRecord(double value, std::uint64_t seed, bool success) {
  const std::string row = "gap=" + std::to_string(value);
  TrialRecord record =
      success ? SampleRecord(row, "default", seed) : FailedRecord(row, "default", seed);
  record.identity = {"sweep gap_width gap", "template", "robot", "settings"};
  record.parameter = "gap";
  record.value = value;
  return record;
}

}  // namespace possibility::experiments::testing
