#include "actions/sagittal/bare_ground.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/sagittal/sagittal_problem.h"
#include "actions/verify/verifier.h"
#include "models/world/scenario.h"

namespace possibility::actions {
namespace {

constexpr double kVast = 20;               // m
constexpr const char* kMotion = "motion";  // action name in the plan

models::Obstacle Floor(const std::string& name, double x, double height) {
  models::Obstacle floor;
  floor.name = name;
  floor.shape = models::Shape::Box({kVast, kVast, 1});
  floor.X_WO.translation() << x, 0, height - 0.5;
  floor.is_ground = true;
  return floor;
}

models::Scenario ScenarioOnBareGround(const SagittalModel& model, const NominalStance& launch,
                                      const NominalStance& landing, double distance,
                                      double height) {
  models::Scenario scenario;
  scenario.environment = BareGround(model, distance, height);
  scenario.environment.bounds = {Eigen::Vector2d(-kVast, -kVast), Eigen::Vector2d(kVast, kVast)};
  scenario.start.action = launch.gait->name;
  models::Stance goal;
  goal.action = landing.gait->name;
  goal.x = distance;
  goal.z = height;
  scenario.goals = {goal};
  scenario.actions = {kMotion, launch.gait->name, landing.gait->name};
  return scenario;
}

}  // namespace

models::Environment BareGround(const SagittalModel& model, double distance, double height) {
  const collocation::Bounds gap = GapBetween(model, distance);
  // If the floors overlapped, one would lie on top of the other.
  const double landing_begin = std::max(gap.lower, gap.upper);
  models::Environment environment;
  environment.obstacles = {Floor("launch ground", gap.lower - kVast / 2, 0),
                           Floor("landing ground", landing_begin + kVast / 2, height)};
  return environment;
}

std::string FaultOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              double distance, double height, const std::vector<Phase>& phases,
                              bool simulates) {
  const models::Scenario scenario = ScenarioOnBareGround(model, launch, landing, distance, height);
  Plan plan;
  plan.robot_hash = robot.content_hash;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  plan.segments = {{kMotion, phases}};
  VerifierSettings settings;
  settings.simulates = simulates;
  settings.measures_margins = false;
  const VerificationReport report = Verify(plan, robot, scenario, settings);
  if (report.accepted()) return {};
  const Violation& worst = report.violations.front();
  return fmt::format("{}: {}, {:.4g} {} (limit {:.4g}) at {:.2f} s", ToString(worst.kind),
                     worst.quantity, worst.value, worst.unit, worst.limit, worst.time);
}

}  // namespace possibility::actions
