#include "actions/verify/verifier.h"

#include <stdexcept>

#include "actions/verify/verifier_contacts.h"
#include "actions/verify/verifier_ends.h"
#include "actions/verify/verifier_flight.h"
#include "actions/verify/verifier_impact.h"
#include "actions/verify/verifier_motion.h"
#include "actions/verify/verifier_problem.h"
#include "actions/verify/verifier_rollouts.h"
#include "actions/verify/verifier_schedule.h"
#include "actions/verify/verifier_structure.h"
#include "common/stopwatch.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

void VerifyAll(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
               const VerifierSettings& settings, ViolationLog* log, VerificationReport* report) {
  CheckFiles(plan, robot, scenario, log);
  if (!CheckStructure(plan, robot, log)) return;
  CheckActions(plan, robot, scenario, log);
  CheckBounds(plan, scenario, log);
  CheckContinuity(plan, robot, log);
  StateEvaluator evaluator(robot);
  CheckEnds(plan, robot, scenario, &evaluator, log);
  const models::GroundMap ground(scenario.environment);
  const VerifiedPlan subject{plan,
                             robot,
                             scenario,
                             ground,
                             FollowContacts(plan, robot, ground, &evaluator),
                             FollowFlights(plan, &evaluator)};
  CheckSchedule(plan, robot, &evaluator, log);
  CheckImpacts(plan, robot, subject.contacts, &evaluator, log);
  VerifyMotion(subject, settings, log, report);
  if (settings.simulates && log->Worst().empty() && !report->cancelled) {
    VerifyRollouts(subject, settings, log, report);
  }
  if (report->cancelled) return;
  report->margins = MeasureMargins(plan, robot, scenario.environment, ground);
}

}  // namespace

std::string ToString(ViolationKind kind) {
  switch (kind) {
    case ViolationKind::kFileMismatch:
      return "file_mismatch";
    case ViolationKind::kStructure:
      return "structure";
    case ViolationKind::kAction:
      return "action";
    case ViolationKind::kStart:
      return "start";
    case ViolationKind::kGoal:
      return "goal";
    case ViolationKind::kBounds:
      return "bounds";
    case ViolationKind::kPositionContinuity:
      return "position_continuity";
    case ViolationKind::kVelocityContinuity:
      return "velocity_continuity";
    case ViolationKind::kImpact:
      return "impact";
    case ViolationKind::kJointPosition:
      return "joint_position";
    case ViolationKind::kJointSpeed:
      return "joint_speed";
    case ViolationKind::kJointTorque:
      return "joint_torque";
    case ViolationKind::kJointCoupling:
      return "joint_coupling";
    case ViolationKind::kContactMotion:
      return "contact_motion";
    case ViolationKind::kContactGround:
      return "contact_ground";
    case ViolationKind::kSchedule:
      return "schedule";
    case ViolationKind::kPenetration:
      return "penetration";
    case ViolationKind::kSelfCollision:
      return "self_collision";
    case ViolationKind::kDynamics:
      return "dynamics";
    case ViolationKind::kFriction:
      return "friction";
    case ViolationKind::kFlight:
      return "flight";
    case ViolationKind::kRollout:
      return "rollout";
  }
  throw std::invalid_argument("unknown kind of violation");
}

VerificationReport Verify(const Plan& plan, const models::RobotModel& robot,
                          const models::Scenario& scenario, const VerifierSettings& settings) {
  if (!(settings.resolution > 0) || settings.threads < 1) {
    throw std::invalid_argument("the verifier needs a positive resolution and number of threads");
  }
  const Stopwatch stopwatch;
  VerificationReport report;
  report.robot_file = robot.file;
  report.scenario_file = scenario.file;
  ViolationLog log;
  VerifyAll(plan, robot, scenario, settings, &log, &report);
  report.violations = log.Worst();
  report.seconds = stopwatch.Seconds();
  return report;
}

}  // namespace possibility::actions
