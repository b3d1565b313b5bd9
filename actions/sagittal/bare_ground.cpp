#include "actions/sagittal/bare_ground.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/rollout/perturbed_rollouts.h"
#include "actions/sagittal/sagittal_problem.h"
#include "actions/verify/verifier.h"
#include "models/world/scenario.h"

namespace possibility::actions {
namespace {

constexpr double kVast = 20;               // m
constexpr const char* kMotion = "motion";  // action name in the plan
constexpr double kHeavier = 0.01;          // share of all masses

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

Plan PlanOnBareGround(const models::RobotModel& robot, const models::Scenario& scenario,
                      const std::vector<Phase>& phases) {
  Plan plan;
  plan.robot_hash = robot.content_hash;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  plan.segments = {{kMotion, phases}};
  return plan;
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
  const Plan plan = PlanOnBareGround(robot, scenario, phases);
  VerifierSettings settings;
  settings.simulates = simulates;
  settings.measures_margins = false;
  const VerificationReport report = Verify(plan, robot, scenario, settings);
  if (report.accepted()) return {};
  const Violation& worst = report.violations.front();
  return fmt::format("{}: {}, {:.4g} {} (limit {:.4g}) at {:.2f} s", ToString(worst.kind),
                     worst.quantity, worst.value, worst.unit, worst.limit, worst.time);
}

std::string FallOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                             const NominalStance& launch, const NominalStance& landing,
                             double distance, double height, const std::vector<Phase>& phases) {
  const models::Scenario scenario = ScenarioOnBareGround(model, launch, landing, distance, height);
  std::vector<Perturbation> perturbations(2);
  perturbations[0].mass = 1 - kHeavier;
  perturbations[1].mass = 1 + kHeavier;
  for (const PerturbedRollout& rollout : RollOutPerturbed(PlanOnBareGround(robot, scenario, phases),
                                                          robot, scenario, perturbations)) {
    if (rollout.survives()) continue;
    return fmt::format("falls over with {:.0f} % of its mass", 100 * rollout.perturbation.mass);
  }
  return {};
}

}  // namespace possibility::actions
