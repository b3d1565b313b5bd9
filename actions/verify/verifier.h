#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/rollout/dynamic_stretch.h"
#include "actions/verify/plan_margins.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Kinds of violations; each kind has its own tolerance (docs/verification.md).
enum class ViolationKind {
  kFileMismatch,  ///< robot or scenario is not the plan's
  kStructure,     ///< no segments, unknown contact, times out of order or apart
  kAction,        ///< an action not allowed by the scenario, or one that does not fit its name
  kStart,         ///< the first state is not the scenario's start at rest
  kGoal,          ///< the last state is not a goal at rest
  kBounds,        ///< the root leaves the scenario's bounds
  kPositionContinuity,  ///< q jumps between phases or segments
  kVelocityContinuity,  ///< v jumps between phases or segments, and no impact is declared
  kImpact,              ///< impulses that do not explain the jump of v, or that no ground can give
  kJointPosition,
  kJointSpeed,  ///< a joint, or the root, is too fast
  kJointTorque,
  kJointCoupling,  ///< a mimic joint does not follow its master
  kContactMotion,  ///< a bearing point moves
  kContactGround,  ///< a bearing point is not on ground
  kSchedule,       ///< the motion does not follow the plan's contact schedule
  kPenetration,    ///< a link is inside the environment
  kSelfCollision,
  kDynamics,  ///< tau and forces do not realise the motion
  kFriction,  ///< a contact force leaves its cone or pulls
  kFlight,    ///< centre of mass off its parabola, or angular momentum not kept
  kRollout,   ///< a simulation of the motion ends elsewhere
};

/// "file_mismatch", "structure", ...: the words of the report.
std::string ToString(ViolationKind kind);

/// The worst violation of one kind over the whole plan.
struct Violation {
  ViolationKind kind = ViolationKind::kStructure;
  int segment = -1;      ///< index, or -1
  double time = 0;       ///< s
  std::string quantity;  ///< e.g. "LKP torque", "left_sole point 2 against floor"
  double value = 0;
  double limit = 0;  ///< largest or least accepted value, tolerance included
  std::string unit;  ///< empty if the violation has no measure
};

struct VerificationReport {
  std::filesystem::path robot_file;  ///< used for verification; empty if not from a file
  std::filesystem::path scenario_file;
  std::vector<Violation> violations;  ///< the worst of each kind; empty: accepted
  /// By dynamic stretch, in order. Empty if the plan has another violation.
  std::vector<StretchRollout> rollouts;
  std::optional<PlanMargins> margins;  ///< none if the plan's structure is broken, or if cancelled
  std::int64_t samples = 0;
  double resolution = 0;  ///< s, largest time between samples
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
  int threads = 1;  ///< samples are independent; the report does not depend on it
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
