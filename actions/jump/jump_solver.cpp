#include "actions/jump/jump_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "actions/sagittal/bare_ground.h"
#include "actions/sagittal/sagittal_solver_options.h"
#include "actions/wholebody/motion_error.h"
#include "collocation/study/optimal_control.h"
#include "common/stopwatch.h"

namespace possibility::actions {
namespace {

/// Intervals per phase, times `fineness`.
std::vector<int> Intervals(double fineness) {
  constexpr std::array<int, JumpProblem::kNumPhases> kIntervals = {10, 4, 4, 4, 8, 8};
  std::vector<int> intervals;
  intervals.reserve(kIntervals.size());
  for (const int count : kIntervals) {
    intervals.push_back(static_cast<int>(std::lround(fineness * count)));
  }
  return intervals;
}

/// A feasible jump needs 17 to 67 iterations. Jumps that need more than this are not worth finding,
/// on any mesh.
constexpr int kMostIterations = 100;
/// Coarse mesh first; finer ones because a motion that the whole robot cannot follow may be the
/// mesh's fault.
constexpr std::array<double, 4> kFineness = {0.6, 1, 1.5, 1.25};

/// Always the same, so that jumps do not depend on the machine.
constexpr int kThreads = 2;

/// Least gap between grounds of different heights, m.
constexpr double kLeastGap = 0.01;

/// The cost only selects among jumps, so it need not be exact; on the first mesh least of all. A
/// jump that the whole robot cannot follow from there is solved more closely, too: that helps.
collocation::SolverOptions Options(bool from_solution) {
  collocation::SolverOptions options =
      from_solution ? SagittalSolverOptions(1e-4, true) : SagittalSolverOptionsWithinBarrier();
  options.max_iterations = kMostIterations;
  options.ipopt.emplace_back("nlp_scaling_method", "none");
  return options;
}

void Add(const collocation::SolverTimes& times, collocation::SolverTimes* sum) {
  sum->total += times.total;
  sum->functions += times.functions;
  sum->derivatives += times.derivatives;
  sum->factorisation += times.factorisation;
  sum->back_solves += times.back_solves;
  sum->rest += times.rest;
}

}  // namespace

JumpSolver::JumpSolver(const models::RobotModel& robot, const NominalStance& launch,
                       const NominalStance& landing, const JumpSettings& settings)
    : robot_(robot),
      launch_(launch),
      landing_(landing),
      settings_(settings),
      model_(robot, launch, landing) {
  settings_.limits.friction = robot.friction;
}

std::string JumpSolver::Identity() const {
  return JumpIdentity(robot_, settings_, launch_.gait->name, landing_.gait->name);
}

JumpAnswer JumpSolver::Solve(const JumpTask& task, const CancellationToken& cancellation,
                             const Log& log) const {
  const Stopwatch stopwatch;
  JumpAnswer answer;
  const collocation::Bounds gap = GapBetween(model_, task.distance);
  if (task.height != 0 && gap.upper - gap.lower < kLeastGap) {
    answer.reason = fmt::format(
        "a jump of {:.3f} m by {:.3f} m would land before the edge of the ground it leaves",
        task.distance, task.height);
    return answer;
  }
  std::optional<collocation::StoredSolution> coarser;
  for (const double fineness : kFineness) {
    if (Attempt(task, fineness, cancellation, log, &coarser, &answer)) break;
  }
  answer.effort.total = stopwatch.Seconds();
  return answer;
}

bool JumpSolver::Attempt(const JumpTask& task, double fineness,
                         const CancellationToken& cancellation, const Log& log,
                         std::optional<collocation::StoredSolution>* coarser,
                         JumpAnswer* answer) const {
  const JumpProblem problem(model_, task, settings_);
  collocation::OptimalControlOptions options;
  options.intervals = Intervals(fineness);
  options.solver = Options(coarser->has_value());
  options.threads = kThreads;
  const collocation::OptimalControlResult result =
      *coarser ? SolveOptimalControl(problem.problem(), **coarser, options, cancellation, log)
               : SolveOptimalControl(problem.problem(), options, std::nullopt, cancellation, log);
  ++answer->effort.attempts;
  answer->effort.iterations += result.iterations;
  Add(result.times, &answer->effort.solver);
  if (result.status == collocation::SolverStatus::kCancelled) {
    answer->cancelled = true;
    return true;
  }
  if (!result.succeeded()) {
    answer->reason = fmt::format("no jump of {:.3f} m by {:.3f} m: {}", task.distance, task.height,
                                 result.message);
    return true;
  }
  RealiseInSpace(problem, result.trajectory, true, answer);
  *coarser = collocation::Store(problem.problem(), result);
  if (answer->jump) answer->solution = *coarser;
  return answer->jump != nullptr;
}

JumpAnswer JumpSolver::Realise(const JumpTask& task,
                               const collocation::StoredSolution& solution) const {
  const Stopwatch stopwatch;
  const JumpProblem problem(model_, task, settings_);
  collocation::CheckSameQuantities(problem.problem(), solution);
  JumpAnswer answer;
  RealiseInSpace(problem, solution.trajectory, false, &answer);
  if (answer.jump) answer.solution = solution;
  answer.effort.total = stopwatch.Seconds();
  return answer;
}

void JumpSolver::RequireSound(const SolvedJump& jump) const {
  const auto [distance, height] = jump.task;
  const std::string fault =
      FaultOnBareGround(robot_, model_, launch_, landing_, distance, height, jump.phases, true);
  if (!fault.empty()) throw MotionError(fault);
}

const std::optional<Phase>& JumpSolver::Preparation(const JumpMotion& motion) const {
  std::call_once(prepared_, [&] { preparation_ = motion.Prepare(); });
  return preparation_;
}

void JumpSolver::RealiseInSpace(const JumpProblem& problem,
                                const collocation::Trajectory& trajectory, bool is_new,
                                JumpAnswer* answer) const {
  const Stopwatch stopwatch;
  auto jump = std::make_shared<SolvedJump>();
  jump->task = problem.task();
  try {
    JumpMotion motion(robot_, model_, launch_, landing_);
    const std::optional<Phase>& preparation = Preparation(motion);
    if (preparation) jump->preparation = preparation->knots.back().t;
    jump->phases = motion.Realise(problem, trajectory, preparation, &jump->report.emplace());
    if (is_new) RequireSound(*jump);
    answer->jump = std::move(jump);
    answer->reason.clear();
  } catch (const MotionError& error) {
    answer->reason = fmt::format("the whole robot cannot follow a jump of {:.3f} m by {:.3f} m: {}",
                                 problem.task().distance, problem.task().height, error.what());
  }
  answer->effort.realisation += stopwatch.Seconds();
}

}  // namespace possibility::actions
