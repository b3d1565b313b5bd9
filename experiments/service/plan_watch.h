#pragma once

#include <filesystem>
#include <functional>

#include "actions/planner/planner.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// What `plan --watch` plans, and how.
struct WatchJob {
  std::filesystem::path scenario;
  std::filesystem::path folder;  ///< of the plan
  bool json = false;
  /// The request for a version of the scenario. @throws InputError if the version does not allow
  /// what the options ask for.
  std::function<actions::PlanRequest(const models::Scenario&)> request_for;
};

/// Plans, and again whenever the scenario's file has changed, until the process is ended. Prints a
/// summary of the first plan and a line for every other; with `json` one object a line for each. A
/// version with an error gets one line, and watching goes on.
/// @throws InputError if the first version has an error or something cannot be written.
void WatchAndPlan(const WatchJob& job);

}  // namespace possibility::experiments
