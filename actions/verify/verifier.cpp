#include "actions/verify/verifier.h"

#include <stdexcept>

#include "actions/checks/contacts_check.h"
#include "actions/checks/ends_check.h"
#include "actions/checks/flight_check.h"
#include "actions/checks/impact_check.h"
#include "actions/checks/problem_check.h"
#include "actions/checks/schedule_check.h"
#include "actions/checks/structure_check.h"
#include "actions/verify/verifier_margins.h"
#include "actions/verify/verifier_motion.h"
#include "actions/verify/verifier_rollouts.h"
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
  const models::GroundMap ground(scenario.environment, robot.friction);
  const models::LocalWorld local_world(scenario.environment, ground);
  const VerifiedPlan subject{plan,
                             robot,
                             scenario,
                             ground,
                             local_world,
                             FollowContacts(plan, robot, ground, &evaluator),
                             FollowFlights(plan, &evaluator)};
  CheckSchedule(plan, robot, &evaluator, log);
  CheckImpacts(plan, robot, subject.contacts, &evaluator, log);
  VerifyMotion(subject, settings, log, report);
  if (settings.simulates && log->Worst().empty() && !report->cancelled) {
    VerifyRollouts(subject, settings, log, report);
  }
  if (report->cancelled) return;
  if (settings.measures_margins) {
    report->margins = MarginsOf(subject, settings.store);
  }
}

}  // namespace

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
