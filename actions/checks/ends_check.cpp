#include "actions/checks/ends_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/plan/contact_name.h"

namespace possibility::actions {
namespace {

constexpr double kPoseTolerance = 1e-3;  // m and rad
/// rad (m if prismatic): a posture's contacts may be 0.1 mm off the ground, which the limbs' joints
/// compensate. Other solutions of inverse kinematics are much farther away.
constexpr double kLimbTolerance = 0.02;
constexpr double kEndSpeed = 1e-6;          // m/s and rad/s
constexpr double kRestAcceleration = 1e-3;  // m/s^2 and rad/s^2

/// One end of the plan and the scenario's requirements there.
struct End {
  ViolationKind kind;
  Instant at;
  const Knot* knot;
  const Phase* phase;
  std::string action;  ///< the segment's action at that end
  const models::Stance* stance;
};

/// "walk->crawl" begins as "walk" and ends as "crawl".
std::string FirstAction(const std::string& action) { return action.substr(0, action.find("->")); }

std::string LastAction(const std::string& action) {
  const std::size_t arrow = action.rfind("->");
  return arrow == std::string::npos ? action : action.substr(arrow + 2);
}

auto Named(const char* text) {
  return [text] { return std::string(text); };
}

/// An action that has no gait of its own (a jump) may start from, or end in, any gait's stance.
void CheckAction(const End& end, const models::RobotModel& robot, ViolationLog* log) {
  const bool is_gait = std::any_of(robot.gaits.begin(), robot.gaits.end(),
                                   [&](const auto& gait) { return gait.name == end.action; });
  if (is_gait && end.action != end.stance->action) {
    log->Report(end.kind, end.at,
                fmt::format("action is {}, the scenario says {}", end.action, end.stance->action));
  }
}

void CheckRest(const End& end, ViolationLog* log) {
  log->RequireAtMost(end.kind, end.at, end.knot->v.cwiseAbs().maxCoeff(), 0, kEndSpeed,
                     "rad/s or m/s", Named("speed, not at rest"));
  log->RequireAtMost(end.kind, end.at, end.knot->a.cwiseAbs().maxCoeff(), 0, kRestAcceleration,
                     "rad/s^2 or m/s^2", Named("acceleration, not at rest"));
}

Eigen::VectorXd Nominal(const End& end, const models::RobotModel& robot, const models::Gait& gait) {
  const models::Stance& stance = *end.stance;
  return robot.Configuration(gait.posture, stance.x, stance.y, stance.yaw, stance.z);
}

void CheckPosture(const End& end, const models::RobotModel& robot, const models::Gait& gait,
                  ViolationLog* log) {
  const Eigen::VectorXd nominal = Nominal(end, robot, gait);
  const Eigen::VectorXd& q = end.knot->q;
  log->RequireAtMost(end.kind, end.at, (q - nominal).segment<2>(4).norm(), 0, kPoseTolerance, "m",
                     Named("root position in the plane, off the stance"));
  log->RequireAtMost(end.kind, end.at, std::abs(q[6] - nominal[6]), 0, kPoseTolerance, "m",
                     Named("root height, off the nominal posture"));
  const Eigen::Quaterniond R(q[0], q[1], q[2], q[3]);
  const Eigen::Quaterniond R_nominal(nominal[0], nominal[1], nominal[2], nominal[3]);
  log->RequireAtMost(end.kind, end.at, R.angularDistance(R_nominal), 0, kPoseTolerance, "rad",
                     Named("root orientation, off the stance"));
  std::vector<bool> moves(robot.num_joints(), false);
  for (const models::GaitLimb& limb : gait.limbs) {
    for (const int joint : limb.joints) moves[joint] = true;
  }
  for (int j = 0; j < robot.num_joints(); ++j) {
    log->RequireAtMost(end.kind, end.at, std::abs(q[7 + j] - nominal[7 + j]), 0,
                       moves[j] ? kLimbTolerance : kPoseTolerance, "rad",
                       [&] { return robot.joints[j].name + ", off the nominal posture"; });
  }
}

/// Checks that the gait's patches are at their places in the nominal posture, and not half a stride
/// away.
void CheckPlaces(const End& end, const models::RobotModel& robot, const models::Gait& gait,
                 StateEvaluator* evaluator, ViolationLog* log) {
  Knot nominal = *end.knot;
  nominal.q = Nominal(end, robot, gait);
  const VerifierState expected = evaluator->Evaluate(nominal);
  const VerifierState state = evaluator->Evaluate(*end.knot);
  for (const models::GaitLimb& limb : gait.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    for (int i = 0; i < static_cast<int>(patch.points.size()); ++i) {
      const BearingPoint point{limb.contact, i, patch.link, patch.points[i]};
      log->RequireAtMost(end.kind, end.at,
                         (state.Position(point) - expected.Position(point)).norm(), 0,
                         kPoseTolerance, "m",
                         [&] { return NameOf(robot, point) + ", off its place in the stance"; });
    }
  }
}

void CheckBearing(const End& end, const models::RobotModel& robot, const models::Gait& gait,
                  StateEvaluator* evaluator, ViolationLog* log) {
  const std::vector<BearingPatch> bearing = BearingPatches(robot, *end.phase);
  for (const models::GaitLimb& limb : gait.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    const bool bears_whole = std::any_of(bearing.begin(), bearing.end(), [&](const auto& b) {
      return b.patch == limb.contact && b.points.size() == patch.points.size();
    });
    if (!bears_whole) log->Report(end.kind, end.at, patch.name + " does not bear as a whole");
  }
  const VerifierState state = evaluator->Evaluate(*end.knot);
  for (const BearingPoint& point : BearingPoints(robot, *end.phase)) {
    log->RequireAtMost(end.kind, end.at, std::abs(state.Position(point).z() - end.stance->z), 0,
                       kPoseTolerance, "m",
                       [&] { return NameOf(robot, point) + ", off the height of the stance"; });
  }
}

void CheckEnd(const End& end, const models::RobotModel& robot, StateEvaluator* evaluator,
              ViolationLog* log) {
  const models::Gait& gait = robot.GaitNamed(end.stance->action);
  CheckAction(end, robot, log);
  CheckRest(end, log);
  CheckPosture(end, robot, gait, log);
  CheckPlaces(end, robot, gait, evaluator, log);
  CheckBearing(end, robot, gait, evaluator, log);
}

}  // namespace

void CheckEnds(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
               StateEvaluator* evaluator, ViolationLog* log) {
  const Segment& first = plan.segments.front();
  const Phase& first_phase = first.phases.front();
  CheckEnd({ViolationKind::kStart,
            {0, first_phase.knots.front().t},
            &first_phase.knots.front(),
            &first_phase,
            FirstAction(first.action),
            &scenario.start},
           robot, evaluator, log);

  const Segment& last = plan.segments.back();
  const Phase& last_phase = last.phases.back();
  const Instant at{static_cast<int>(plan.segments.size()) - 1, last_phase.knots.back().t};
  if (plan.goal < 0 || plan.goal >= static_cast<int>(scenario.goals.size())) {
    log->Report(ViolationKind::kGoal, at,
                fmt::format("goal {} of {}", plan.goal, scenario.goals.size()));
    return;
  }
  CheckEnd({ViolationKind::kGoal, at, &last_phase.knots.back(), &last_phase,
            LastAction(last.action), &scenario.goals[plan.goal]},
           robot, evaluator, log);
}

}  // namespace possibility::actions
