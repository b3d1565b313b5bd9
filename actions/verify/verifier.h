#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actions/evidence/violation.h"
#include "actions/plan/plan.h"
#include "actions/rollout/dynamic_stretch.h"
#include "actions/verify/plan_margins.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

struct VerdictStore;

struct VerificationReport {
  std::filesystem::path robot_file;  ///< used for verification; empty if not from a file
  std::filesystem::path scenario_file;
  std::vector<Violation> violations;  ///< the worst of each kind; empty: accepted
  /// By dynamic stretch, in order. Empty if the plan has another violation.
  std::vector<StretchRollout> rollouts;
  /// None if the plan's structure is broken, if cancelled, or if they were not asked for.
  std::optional<PlanMargins> margins;
  std::int64_t samples = 0;
  std::int64_t kept_samples = 0;  ///< of these, whose verdict VerifierSettings::store had
  int kept_rollouts = 0;          ///< of `rollouts`, likewise
  double resolution = 0;          ///< s, largest time between samples
  /// Bounds on deviations from the straight line between two samples: of bearing points (m), and of
  /// joint torques and the wrench on the root (N; N m, over 1 m).
  double position_resolution = 0;
  double force_resolution = 0;
  double seconds = 0;
  bool cancelled = false;
  bool accepted() const { return violations.empty() && !cancelled; }
};

struct VerifierSettings {
  CancellationToken cancellation;  ///< asked regularly, from any thread
  /// Called as often, from any thread, with the fraction done. May be empty.
  std::function<void(double)> progress;
  double resolution = 0.005;  ///< s, largest sample time; fast motions are sampled more densely
  /// Also simulates dynamic stretches: seconds for each.
  bool simulates = true;
  bool measures_margins = true;
  int threads = 1;  ///< samples are independent; the report does not depend on it
  /// Parts accepted earlier (verdict_store.h), which are not checked again where the world about
  /// them is the same; accepted parts are added. The report is the one without a store, except
  /// for what was kept. Null: none. Must outlive the call.
  VerdictStore* store = nullptr;
};

/// Verifies from the plan, the robot and the scenario alone that the plan can be executed. Never
/// uses the planner's constraint functions: has its own sampling, exact geometry and Simbody
/// inverse dynamics. If the plan's structure is broken, or the robot or scenario does not fit its
/// sizes, it checks only kFileMismatch and kStructure. Simulates dynamic stretches
/// if there is no other violation.
/// @throws std::invalid_argument if the resolution or the number of threads is not positive;
///   InputError if the scenario names an action for which the robot has no gait.
VerificationReport Verify(const Plan& plan, const models::RobotModel& robot,
                          const models::Scenario& scenario, const VerifierSettings& settings = {});

}  // namespace possibility::actions
