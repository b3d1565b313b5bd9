#include "actions/sagittal/bare_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <thread>

#include "actions/rollout/dynamic_stretch.h"
#include "actions/rollout/perturbed_rollout.h"
#include "actions/rollout/rollout_check.h"
#include "actions/sagittal/folded_motion.h"
#include "actions/sagittal/sagittal_problem.h"
#include "actions/verify/verifier.h"
#include "actions/verify/verifier_rollouts.h"
#include "actions/wholebody/motion_error.h"
#include "common/run_on_threads.h"
#include "models/world/ground_map.h"
#include "models/world/scenario.h"

namespace possibility::actions {
namespace {

constexpr double kVast = 20;               // m
constexpr const char* kMotion = "motion";  // action name in the plan
constexpr double kHeavier = 0.01;          // share of all masses
/// m: a hand that slides in the simulation has no sole that reaches back across the edge.
constexpr double kSlides = 0.01;
/// Simulations at once, or threads that verify.
constexpr int kThreads = 3;

int Threads() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kThreads);
}

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

std::string TextOf(const Violation& fault) {
  return fmt::format("{}: {}, {:.4g} {} (limit {:.4g}) at {:.2f} s", ToString(fault.kind),
                     fault.quantity, fault.value, fault.unit, fault.limit, fault.time);
}

std::string FaultWithoutSimulation(const Plan& plan, const models::RobotModel& robot,
                                   const models::Scenario& scenario) {
  VerifierSettings settings;
  settings.simulates = false;
  settings.measures_margins = false;
  settings.threads = Threads();
  const VerificationReport report = Verify(plan, robot, scenario, settings);
  return report.accepted() ? std::string() : TextOf(report.violations.front());
}

std::string FaultInSimulation(const DynamicStretch& stretch, const models::RobotModel& robot,
                              const models::GroundMap& ground) {
  RolloutCheckSettings check;
  check.measures_torque = false;
  const std::vector<Violation> faults =
      RolloutViolations({stretch.first_segment, stretch.last_segment,
                         RollOutSegment(stretch.motion, robot, ground, check)});
  return faults.empty() ? std::string() : TextOf(faults.front());
}

/// The folded robot drifts as the whole one does, within some percent, in a third of the time.
bool Survives(const DynamicStretch& stretch, const models::RobotModel& robot,
              const SagittalModel& model, const models::GroundMap& ground,
              const Perturbation& perturbation) {
  PerturbedRolloutSettings settings;
  settings.compares = false;
  const std::optional<FoldedMotion> folded = FoldMotion(model.reduction(), stretch.motion);
  if (!folded) {
    return RollOutPerturbed(stretch.motion, robot, ground, perturbation, settings).survives();
  }
  settings.gains = folded->gains;
  return RollOutPerturbed(folded->motion, folded->robot, ground, perturbation, settings).survives();
}

std::string FallWith(double mass, const DynamicStretch& stretch, const models::RobotModel& robot,
                     const SagittalModel& model, const models::GroundMap& ground) {
  Perturbation perturbation;
  perturbation.mass = mass;
  if (Survives(stretch, robot, model, ground, perturbation)) return {};
  return fmt::format("falls over with {:.0f} % of its mass", 100 * mass);
}

/// Returns a fault; empty if there is none.
using Trial = std::function<std::string()>;

/// Begins no trial after one has failed.
std::string FirstFault(const std::vector<Trial>& trials) {
  try {
    ForEachOnThreads(Threads(), trials.size(), [&trials](std::size_t i) {
      if (const std::string fault = trials[i](); !fault.empty()) throw MotionError(fault);
    });
  } catch (const MotionError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

models::Environment BareGround(const SagittalModel& model, double distance, double height,
                               double farther) {
  const collocation::Bounds gap = GapBetween(model, distance);
  // If the floors overlapped, one would lie on top of the other.
  const double landing_begin = std::max(gap.lower, gap.upper - farther);
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
  if (std::string fault = FaultWithoutSimulation(plan, robot, scenario);
      !fault.empty() || !simulates) {
    return fault;
  }
  std::vector<Trial> trials;
  const models::GroundMap ground(BareGround(model, distance, height, kSlides), robot.friction);
  const std::vector<DynamicStretch> stretches = DynamicStretches(plan);
  for (const DynamicStretch& stretch : stretches) {
    // It takes longer than the others, so it begins before them.
    trials.push_back([&] { return FaultInSimulation(stretch, robot, ground); });
    for (const double mass : {1 - kHeavier, 1 + kHeavier}) {
      trials.push_back([&, mass] { return FallWith(mass, stretch, robot, model, ground); });
    }
  }
  return FirstFault(trials);
}

}  // namespace possibility::actions
