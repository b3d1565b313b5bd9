#include "actions/transition/transition_solver.h"

#include <optional>

#include "actions/motion/phase_sequence.h"
#include "actions/sagittal/bare_ground.h"
#include "actions/sagittal/sagittal_solver_options.h"
#include "actions/sagittal/stance_motion.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "collocation/study/optimal_control.h"
#include "common/cancellation_token.h"

namespace possibility::actions {
namespace {

/// Intervals of the two phases. The finer mesh is tried because a motion that the whole robot
/// cannot follow may be the coarse mesh's fault.
constexpr int kIntervals[][SitDownProblem::kNumPhases] = {{14, 8}, {20, 12}};

}  // namespace

TransitionSolver::TransitionSolver(const models::RobotModel& robot, const NominalStance& from,
                                   const NominalStance& to, const SitDownSettings& settings)
    : robot_(robot), from_(from), to_(to), settings_(settings), model_(robot, from, to) {
  settings_.limits.friction = robot.friction;
}

SolvedTransition TransitionSolver::Solve(const CancellationToken& cancellation) const {
  const SitDownProblem problem(model_, settings_);
  std::string fault;
  std::optional<collocation::StoredSolution> coarser;
  for (const auto& intervals : kIntervals) {
    collocation::OptimalControlOptions options;
    options.intervals = {std::begin(intervals), std::end(intervals)};
    options.solver = SagittalSolverOptions(1e-5, coarser.has_value());
    const collocation::OptimalControlResult result =
        coarser ? SolveOptimalControl(problem.problem(), *coarser, options, cancellation)
                : SolveOptimalControl(problem.problem(), options, std::nullopt, cancellation);
    if (result.status == collocation::SolverStatus::kCancelled) throw Cancelled();
    fault = result.message;
    if (!result.succeeded()) continue;
    coarser = collocation::Store(problem.problem(), result);
    try {
      SolvedTransition solved{InSpace(result.trajectory), *coarser};
      fault = FaultOnBareGround(robot_, model_, from_, to_, SitDownProblem::Displacement(model_), 0,
                                solved.phases);
      if (fault.empty()) return solved;
    } catch (const MotionError& error) {
      fault = error.what();
    }
  }
  throw MotionError(fault);
}

SolvedTransition TransitionSolver::Realise(const collocation::StoredSolution& solution) const {
  const SitDownProblem problem(model_, settings_);
  collocation::CheckSameQuantities(problem.problem(), solution);
  return {InSpace(solution.trajectory), solution};
}

std::vector<Phase> TransitionSolver::InSpace(const collocation::Trajectory& trajectory) const {
  const collocation::PhaseTrajectory& sit = trajectory.phases[SitDownProblem::kSit];
  const collocation::PhaseTrajectory& bear = trajectory.phases[SitDownProblem::kBear];
  StanceMotion stance(robot_, model_, from_, to_);
  const Support feet = stance.LaunchFeet();
  const Support all = stance.LandingAll(SitDownProblem::Displacement(model_), 0);
  std::vector<Phase> motion = stance.Begin(
      [&](const Knot& from) { return stance.FollowUntilPlaced(sit, from, feet, all); });
  Append(stance.Follow(bear, motion.back().knots.back(), all), &motion);
  return motion;
}

}  // namespace possibility::actions
