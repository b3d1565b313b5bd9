#include "experiments/legged/walk_from_rest.h"

#include "actions/gait/foothold_plan.h"
#include "actions/spatial/spatial_solver.h"
#include "actions/wholebody/nominal_stance.h"
#include "experiments/legged/walking_step.h"

namespace possibility::experiments {
namespace {

constexpr actions::StepTiming kTiming = {
    .swing = 0.6, .swing_length = 0.4, .double_support = 0.12, .start = 0.5};
constexpr double kLateral = 0.15;  // m, and rad: not used on a straight way
constexpr double kTurn = 0.3;
constexpr int kForward = 4;  // of a robot's q, after the root's quaternion

}  // namespace

std::unique_ptr<collocation::OptimalControlProblem> WalkFromRest(
    const models::RobotModel& humanoid, const WalkFromRestSettings& settings) {
  const actions::NominalStance stance =
      actions::SolveNominalStance(humanoid, humanoid.GaitNamed("walk"));
  const auto feet = actions::SwingGroups(stance);
  const auto steps = actions::PlanSteps(stance, feet, {{}, {settings.distance, 0, 0}},
                                        {settings.longest_step, kLateral, kTurn});
  const models::ContactSchedule schedule =
      actions::ScheduleOf(humanoid, stance, feet, {}, steps, kTiming);
  Eigen::VectorXd end = stance.q;
  end[kForward] += settings.distance;
  actions::SpatialSettings problem = actions::SpatialSolverSettings::ProblemDefaults();
  problem.sequence.limits.friction = humanoid.friction;
  problem.locked = StillArmJoints(humanoid, *stance.gait);
  return actions::StateSpatialProblem(humanoid, *stance.gait, schedule, stance.q, end, problem)
      .problem;
}

}  // namespace possibility::experiments
