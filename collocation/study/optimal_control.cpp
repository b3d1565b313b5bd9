#include "collocation/study/optimal_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "collocation/diagnosis/conflict.h"
#include "collocation/study/conflict_text.h"
#include "collocation/study/mesh_refinement.h"
#include "collocation/study/scale_check.h"
#include "common/stopwatch.h"

namespace possibility::collocation {

namespace {

std::vector<Mesh> FirstMeshes(const OptimalControlProblem& problem,
                              const OptimalControlOptions& options) {
  if (!options.meshes.empty()) return options.meshes;
  const std::vector<int>& intervals = options.intervals;
  const auto n = static_cast<std::size_t>(problem.num_phases());
  if (intervals.size() != 1 && intervals.size() != n) {
    throw std::invalid_argument(fmt::format("{}: {} numbers of intervals for {} phases",
                                            problem.name(), intervals.size(), n));
  }
  std::vector<Mesh> meshes;
  for (std::size_t p = 0; p < n; ++p) {
    meshes.push_back(UniformMesh(intervals.size() == 1 ? intervals[0] : intervals[p]));
  }
  return meshes;
}

/// The worst violation of each constraint, by its name without the point.
std::map<std::string, ConstraintViolation> Violations(const Transcription& program,
                                                      const SolverResult& solution) {
  std::map<std::string, ConstraintViolation> violations;
  for (int i = 0; i < program.num_constraints() && i < solution.constraints.size(); ++i) {
    const double g = solution.constraints[i];
    const double amount =
        std::max({0.0, program.constraint_lower()[i] - g, g - program.constraint_upper()[i]}) *
        program.ConstraintScale(i);
    ConstraintViolation& worst = violations[program.ConstraintGroup(i)];
    if (worst.where.empty() || amount > worst.amount) worst = {amount, program.ConstraintName(i)};
  }
  return violations;
}

void AddUp(const SolverResult& solution, OptimalControlResult* result) {
  result->iterations += solution.history.empty() ? 0 : solution.history.back().number;
  const auto add = [](auto* to, const auto& from, auto... members) {
    ((to->*members += from.*members), ...);
  };
  add(&result->times, solution.times, &SolverTimes::total, &SolverTimes::functions,
      &SolverTimes::derivatives, &SolverTimes::factorisation, &SolverTimes::back_solves,
      &SolverTimes::second_order, &SolverTimes::rest);
  add(&result->evaluations, solution.evaluations, &SolverEvaluations::objective,
      &SolverEvaluations::gradient, &SolverEvaluations::constraints, &SolverEvaluations::jacobian,
      &SolverEvaluations::hessian);
}

/// Starting point of the first solve: a motion, possibly with multipliers, or the problem's
/// guesses.
struct Start {
  const Trajectory* trajectory = nullptr;
  const Multipliers* multipliers = nullptr;
};

SolverGuess GuessOf(const Transcription& program, const Start& start) {
  SolverGuess guess;
  guess.x = start.trajectory ? program.GuessFrom(*start.trajectory) : program.InitialGuess();
  if (start.multipliers) program.AddMultipliers(*start.multipliers, *start.trajectory, &guess);
  return guess;
}

OptimalControlResult AsCancelled(OptimalControlResult result) {
  result.status = SolverStatus::kCancelled;
  result.message = "cancelled";
  result.multipliers = {};  // from an earlier mesh
  result.violations.clear();
  result.mesh_error = std::numeric_limits<double>::quiet_NaN();
  result.mesh_errors = {};
  result.jumps.clear();
  result.conflict.clear();
  result.stationary_point = StationaryPoint::kUnknown;
  return result;
}

/// The greatest objective of any iterate, in magnitude.
double ObjectiveSize(const SolverResult& solution) {
  double size = std::abs(solution.objective);
  for (const SolverIteration& iteration : solution.history) {
    size = std::max(size, std::abs(iteration.objective));
  }
  return size;
}

/// How the programs of one problem are solved.
struct Method {
  const NonlinearSolver& solver;
  SolverOptions options;
  const CancellationToken& cancellation;
  const std::function<void(const SolverIteration&)>& log;
  int threads;

  SolverResult Solve(Transcription* program, const SolverGuess& guess) const {
    return solver.Solve(program, guess, options, cancellation, log);
  }
};

/// Solves. If the objective proves small, puts its size into the options and solves again, from
/// there: an objective of 1e-9 is optimal to a tolerance of 1e-8 everywhere.
SolverResult SolveToSize(Transcription* program, const SolverGuess& guess, Method* method,
                         OptimalControlResult* result) {
  constexpr double kSmall = 1e-2;  // of the size that was expected
  SolverResult solution = method->Solve(program, guess);
  AddUp(solution, result);
  const double size = ObjectiveSize(solution);
  if (!solution.succeeded() || !(size > 0) || size >= kSmall * method->options.objective_size) {
    return solution;
  }
  method->options.objective_size = size;
  solution = method->Solve(program, {solution.x, {}, {}, {}});
  AddUp(solution, result);
  return solution;
}

bool FoundNoFeasiblePoint(const SolverResult& solution, const SolverOptions& options) {
  const bool gave_up = solution.status == SolverStatus::kInfeasible ||
                       solution.status == SolverStatus::kIterationLimit ||
                       solution.status == SolverStatus::kFailed;
  return gave_up && !(solution.worst_violation <= options.constraint_tolerance);
}

/// Names what conflicts, or solves again from a point that meets all constraints.
void Explain(Transcription* program, const Method& method, OptimalControlResult* result) {
  const Conflict conflict =
      FindConflict(program, result->solver.x, method.options, method.cancellation);
  if (!conflict.members.empty()) {
    result->conflict = Describe(conflict, *program);
    return;
  }
  result->solver = method.Solve(program, {conflict.x, {}, {}, {}});
  AddUp(result->solver, result);
}

/// Minimum or saddle?
void CheckSecondOrder(Transcription* program, const Method& method, OptimalControlResult* result) {
  if (!method.solver.has_multipliers()) return;
  const Stopwatch stopwatch;
  result->stationary_point =
      ClassifyStationaryPoint(program, result->solver, method.options, method.cancellation);
  result->times.second_order = stopwatch.Seconds();
  result->times.total += result->times.second_order;
  if (result->stationary_point == StationaryPoint::kSaddle) {
    result->message += ", but not a minimum: motions beside it cost less (to second order)";
  }
}

/// Whether a derivative is wrong, in which case the result is complete.
bool FoundWrongDerivative(const Transcription& program, const SolverGuess& guess,
                          const CancellationToken& cancellation, OptimalControlResult* result) {
  const std::vector<std::string> wrong = program.WrongDerivatives(guess.x, cancellation);
  if (wrong.empty()) return false;
  result->status = SolverStatus::kWrongDerivative;
  result->message = wrong.front();
  if (wrong.size() > 1) result->message += fmt::format(" (and {} more)", wrong.size() - 1);
  result->objective = std::numeric_limits<double>::quiet_NaN();
  result->mesh_error = std::numeric_limits<double>::quiet_NaN();
  result->trajectory = program.TrajectoryOf(guess.x);
  result->solver.status = result->status;
  result->solver.message = result->message;
  return true;
}

bool IsFineEnough(const OptimalControlResult& result, const OptimalControlOptions& options) {
  const bool is_accurate =
      options.mesh_tolerance <= 0 || result.mesh_error <= options.mesh_tolerance;
  for (const auto& of_phase : result.jumps) {
    for (const ControlJump& jump : of_phase) {
      if (jump.end - jump.begin > options.jump_tolerance) return false;
    }
  }
  return is_accurate;
}

std::vector<Mesh> NextMeshes(const std::vector<Mesh>& meshes,
                             const std::vector<std::vector<MeshError>>& errors,
                             const std::vector<std::vector<ControlJump>>& jumps,
                             const OptimalControlOptions& options) {
  MeshRule rule;
  rule.order = options.scheme.order();
  if (options.mesh_tolerance > 0) {
    rule.tolerance = options.mesh_tolerance;
    rule.coarsen = options.coarsen;
  }
  std::vector<Mesh> next;
  for (std::size_t p = 0; p < meshes.size(); ++p) {
    next.push_back(Refined(meshes[p], errors[p], rule));
    if (jumps.empty()) continue;
    next.back() = WithKnotsAtJumps(next.back(), meshes[p], jumps[p], options.jump_tolerance);
  }
  return next;
}

/// Whether a coarser mesh is worth a solve of its own: a small program is solved at once, and half
/// of the intervals would take as long as they save.
bool IsWorthwhile(const std::vector<Mesh>& coarse, const std::vector<Mesh>& meshes,
                  const Transcription& program) {
  constexpr int kLarge = 1200;  // variables
  const auto intervals = [](const std::vector<Mesh>& of) {
    std::size_t sum = 0;
    for (const Mesh& mesh : of) sum += mesh.size() - 1;
    return sum;
  };
  return program.num_variables() > kLarge && 3 * intervals(coarse) < intervals(meshes);
}

/// Where the solve of a program starts: from a solution on a coarser mesh, which is solved in the
/// same way (nested iteration), or from the problem's guesses if that is not worthwhile or fails.
SolverGuess GuessFromCoarse(const OptimalControlProblem& problem, const Transcription& program,
                            const TranscriptionScheme& scheme, const std::vector<Mesh>& meshes,
                            Method* method, OptimalControlResult* result) {
  std::vector<Mesh> coarse(meshes.size());
  std::transform(meshes.begin(), meshes.end(), coarse.begin(), Coarse);
  if (!IsWorthwhile(coarse, meshes, program)) return GuessOf(program, {});
  Transcription smaller(problem, scheme, coarse, method->cancellation, method->threads);
  const SolverGuess guess = GuessFromCoarse(problem, smaller, scheme, coarse, method, result);
  const SolverResult solution = SolveToSize(&smaller, guess, method, result);
  result->trajectory = smaller.TrajectoryOf(solution.x);
  if (solution.status == SolverStatus::kCancelled) throw Cancelled();
  if (!solution.succeeded()) return GuessOf(program, {});
  if (!method->solver.has_multipliers()) return GuessOf(program, {&result->trajectory, nullptr});
  const Multipliers multipliers = smaller.MultipliersOf(solution);
  return GuessOf(program, {&result->trajectory, &multipliers});
}

void SolveFrom(Start start, const OptimalControlProblem& problem,
               const OptimalControlOptions& options, const CancellationToken& cancellation,
               const std::function<void(const SolverIteration&)>& log, OptimalControlResult* out) {
  OptimalControlResult& result = *out;
  CheckScales(problem, options.solver.constraint_tolerance);
  std::vector<Mesh> meshes = FirstMeshes(problem, options);
  const NonlinearSolver& solver =
      options.nonlinear_solver ? *options.nonlinear_solver : IpoptSolver();
  Method method{solver, options.solver, cancellation, log, options.threads};
  for (;; ++result.refinements) {
    Transcription program(problem, options.scheme, meshes, cancellation, options.threads);
    SolverGuess guess = GuessOf(program, start);
    if (result.refinements == 0) {
      result.dual_start = guess.constraint_multipliers.size() > 0;
      const bool check = options.check_derivatives;
      if (check && FoundWrongDerivative(program, guess, cancellation, &result)) return;
      if (options.coarse_first && !start.trajectory) {
        guess = GuessFromCoarse(problem, program, options.scheme, meshes, &method, &result);
      }
    }
    result.solver = SolveToSize(&program, guess, &method, &result);
    if (options.explain_infeasible && FoundNoFeasiblePoint(result.solver, method.options)) {
      Explain(&program, method, &result);
    }
    result.status = result.solver.status;
    result.message = result.solver.message;
    result.objective = result.solver.objective;
    result.trajectory = program.TrajectoryOf(result.solver.x);
    if (result.status == SolverStatus::kCancelled) throw Cancelled();
    if (solver.has_multipliers()) result.multipliers = program.MultipliersOf(result.solver);
    result.violations = Violations(program, result.solver);
    const auto errors = MeshErrors(problem, result.trajectory, result.objective);
    result.mesh_errors = Worst(errors);
    result.mesh_error = result.mesh_errors.Greatest();
    if (options.jump_tolerance > 0) result.jumps = FindJumps(result.trajectory);
    if (!result.succeeded() || IsFineEnough(result, options) ||
        result.refinements >= options.max_refinements) {
      if (options.second_order_check) CheckSecondOrder(&program, method, &result);
      return;
    }
    meshes = NextMeshes(meshes, errors, result.jumps, options);
    start = {&result.trajectory, solver.has_multipliers() ? &result.multipliers : nullptr};
  }
}

OptimalControlResult SolveOrCancel(const Start& start, const OptimalControlProblem& problem,
                                   const OptimalControlOptions& options,
                                   const CancellationToken& cancellation,
                                   const std::function<void(const SolverIteration&)>& log) {
  OptimalControlResult result;
  try {
    SolveFrom(start, problem, options, cancellation, log, &result);
  } catch (const Cancelled&) {
    return AsCancelled(std::move(result));
  }
  return result;
}

}  // namespace

OptimalControlResult SolveOptimalControl(const OptimalControlProblem& problem,
                                         const OptimalControlOptions& options,
                                         const std::optional<Trajectory>& guess,
                                         const CancellationToken& cancellation,
                                         const std::function<void(const SolverIteration&)>& log) {
  return SolveOrCancel({guess ? &*guess : nullptr, nullptr}, problem, options, cancellation, log);
}

OptimalControlResult SolveOptimalControl(const OptimalControlProblem& problem,
                                         const StoredSolution& start,
                                         const OptimalControlOptions& options,
                                         const CancellationToken& cancellation,
                                         const std::function<void(const SolverIteration&)>& log) {
  CheckSameQuantities(problem, start);
  return SolveOrCancel({&start.trajectory, &start.multipliers}, problem, options, cancellation,
                       log);
}

StoredSolution Store(const OptimalControlProblem& problem, const OptimalControlResult& result) {
  StoredSolution stored{
      problem.name(), {}, problem.ParameterNames(), result.trajectory, result.multipliers};
  for (int p = 0; p < problem.num_phases(); ++p) {
    stored.phases.push_back(problem.phase(p).Names());
  }
  return stored;
}

}  // namespace possibility::collocation
