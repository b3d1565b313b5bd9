#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/plan/plan.h"
#include "actions/planner/planner_switches.h"
#include "actions/verify/verifier.h"
#include "common/cancellation_token.h"
#include "graph/search/find_path.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

class PlannerMemory;

struct PlanResult;

enum class PlanStatus { kFound, kProvenInfeasible, kExhausted, kTimeLimit };

/// "found", "proven_infeasible", "exhausted", "time_limit": the words of the JSON contract.
std::string ToString(PlanStatus status);

struct PlanProgress {
  std::string stage;  ///< "exploring", "generating motion", "verifying"
  graph::FindPathProgress graph;
  double fraction = 0;  ///< of the stage, in [0, 1]; 0 if unknown
};

struct PlanRequest {
  std::uint64_t seed = 1;
  int threads = 1;
  /// s, for preparation and search. Motion and verification of a route found in time may take the
  /// same time again.
  double time_limit = 60;
  /// Actions that replace the scenario's in search and verification; empty: the scenario's. A plan
  /// with actions that the scenario's file does not list is not valid for that file.
  std::vector<std::string> actions;
  /// Gaits and manoeuvres in addition to those of the robot's file; `actions` may name them.
  std::vector<GaitFactory> gaits;
  std::vector<ManoeuvreFactory> manoeuvres;
  std::filesystem::path library;  ///< folder of solved jumps; empty: none
  PlannerPreset preset = PlannerPreset::kDefault;
  std::vector<std::string> explorers;  ///< instead of the preset's (WithExplorers) unless empty
  int plan_version = 1;  ///< format of the file that the plan is for, 1 or 2: how it is rounded
  /// Kept between requests (planner_memory.h); null: none. Must outlive the call. The plan does not
  /// depend on it.
  PlannerMemory* memory = nullptr;
  /// If set, planning goes on after the first plan until the time limit, or until the plan is as
  /// quick as any can be, verification included. Called with the first plan and with each
  /// that is quicker; all are verified. The result is the last of them.
  std::function<void(const PlanResult&)> improved;
  std::function<void(const PlanProgress&)> progress;
  /// Asked from any thread; once it cancels, PlanTraversal throws Cancelled.
  CancellationToken cancellation;
};

struct PlanResult {
  PlanStatus status = PlanStatus::kTimeLimit;
  Plan plan;  ///< segments if kFound, otherwise `no`; graph and statistics always
  VerificationReport verification;  ///< accepted if kFound
  /// One paragraph: which conditions rejected what, and where. If kFound: the manoeuvres refuted
  /// and the jobs failed during the search; empty if none.
  std::string explanation;
  /// Lower bound of the duration of all plans that the planner could make (LeastDuration), s; 0:
  /// not asked for. Set if PlanRequest::improved is.
  double least_duration = 0;
};

/// Plans, generates the motion and verifies it. A plan that fails verification is never returned:
/// its edge is marked impossible and the search continues until the time limit.
/// @throws InputError if start or goal is in collision or off the ground, if an action is unknown,
/// if the name of a gait or manoeuvre of the request is taken, if its factory returns none, if a
/// gait cannot execute its extreme strides, or if a condition of a manoeuvre throws (the message
/// names action, function and pose). Exceptions of a factory pass through.
PlanResult PlanTraversal(const models::RobotModel& robot, const models::Scenario& scenario,
                         const PlanRequest& request);

}  // namespace possibility::actions
