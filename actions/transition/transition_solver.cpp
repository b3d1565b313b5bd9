#include "actions/transition/transition_solver.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

#include "actions/motion/motion_builder.h"
#include "actions/motion/phase_sequence.h"
#include "actions/sagittal/bare_ground.h"
#include "actions/sagittal/stance_motion.h"
#include "collocation/study/optimal_control.h"

namespace possibility::actions {
namespace {

/// Intervals of the two phases. The finer mesh is tried because a motion that the whole robot
/// cannot follow may be the coarse mesh's fault.
constexpr int kIntervals[][SitDownProblem::kNumPhases] = {{14, 8}, {20, 12}};

/// Cancels a solve once it is no longer wanted; active during its lifetime.
class Canceller {
 public:
  Canceller(const std::function<bool()>& keep_going, collocation::SolveControl* control) {
    if (!keep_going) return;
    watcher_ = std::jthread([keep_going, control](const std::stop_token& stop) {
      constexpr auto kPeriod = std::chrono::milliseconds(5);
      std::mutex mutex;
      std::condition_variable_any stopped;
      std::unique_lock lock(mutex);
      while (!stopped.wait_for(lock, stop, kPeriod, [&] { return stop.stop_requested(); })) {
        if (!keep_going()) return control->Cancel();
      }
    });
  }

 private:
  std::jthread watcher_;
};

}  // namespace

TransitionSolver::TransitionSolver(const models::RobotModel& robot, const NominalStance& from,
                                   const NominalStance& to, const SitDownSettings& settings)
    : robot_(robot), from_(from), to_(to), settings_(settings), model_(robot, from, to) {
  settings_.limits.friction = robot.friction;
}

SolvedTransition TransitionSolver::Solve(const std::function<bool()>& keep_going) const {
  const SitDownProblem problem(model_, settings_);
  std::string fault;
  for (const auto& intervals : kIntervals) {
    collocation::OptimalControlOptions options;
    options.intervals = {std::begin(intervals), std::end(intervals)};
    options.solver.tolerance = 1e-5;
    options.solver.constraint_tolerance = 1e-7;
    collocation::SolveControl control;
    const Canceller canceller(keep_going, &control);
    const collocation::OptimalControlResult result =
        collocation::SolveOptimalControl(problem.problem(), options, std::nullopt, &control);
    if (result.status == collocation::SolverStatus::kCancelled) throw Abandoned();
    fault = result.message;
    if (!result.succeeded()) continue;
    try {
      SolvedTransition solved{InSpace(result.trajectory),
                              collocation::Store(problem.problem(), result)};
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
  std::vector<Phase> motion;
  Append(stance.Prepare(), &motion);
  Append(stance.FollowUntilPlaced(sit, stance.PlannedKnot(sit, 0), feet, all), &motion);
  Append(stance.Follow(bear, motion.back().knots.back(), all), &motion);
  return motion;
}

}  // namespace possibility::actions
