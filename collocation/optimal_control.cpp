#include "collocation/optimal_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace possibility::collocation {

namespace {

std::vector<Mesh> FirstMeshes(const OptimalControlProblem& problem,
                              const std::vector<int>& intervals) {
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

/// The worst of each constraint, by its name without the point.
std::map<std::string, ConstraintViolation> Violations(const Transcription& program,
                                                      const SolverResult& solution) {
  std::map<std::string, ConstraintViolation> violations;
  for (int i = 0; i < program.num_constraints() && i < solution.constraints.size(); ++i) {
    const double g = solution.constraints[i];
    const double amount =
        std::max({0.0, program.constraint_lower()[i] - g, g - program.constraint_upper()[i]}) *
        program.ConstraintScale(i);
    const std::string where = program.ConstraintName(i);
    ConstraintViolation& worst = violations[program.ConstraintGroup(i)];
    if (worst.where.empty() || amount > worst.amount) worst = {amount, where};
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
      &SolverTimes::rest);
  add(&result->evaluations, solution.evaluations, &SolverEvaluations::objective,
      &SolverEvaluations::gradient, &SolverEvaluations::constraints, &SolverEvaluations::jacobian,
      &SolverEvaluations::hessian);
}

double Greatest(const std::vector<std::vector<double>>& errors) {
  double greatest = 0;
  for (const auto& phase : errors) {
    for (const double error : phase) greatest = std::max(greatest, error);
  }
  return greatest;
}

}  // namespace

OptimalControlResult SolveOptimalControl(const OptimalControlProblem& problem,
                                         const OptimalControlOptions& options,
                                         const std::optional<Trajectory>& guess,
                                         SolveControl* control,
                                         const std::function<void(const SolverIteration&)>& log) {
  std::vector<Mesh> meshes = FirstMeshes(problem, options.intervals);
  OptimalControlResult result;
  for (;; ++result.refinements) {
    Transcription program(problem, options.scheme, meshes);
    SolverGuess start;
    if (result.refinements > 0) {
      start.x = program.GuessFrom(result.trajectory);
    } else {
      start.x = guess ? program.GuessFrom(*guess) : program.InitialGuess();
    }
    result.solver = Solve(&program, start, options.solver, control, log);
    AddUp(result.solver, &result);
    result.status = result.solver.status;
    result.message = result.solver.message;
    result.objective = result.solver.objective;
    result.trajectory = program.TrajectoryOf(result.solver.x);
    result.violations = Violations(program, result.solver);
    const auto errors = MeshErrors(problem, result.trajectory);
    result.mesh_error = Greatest(errors);
    const bool fine_enough =
        options.mesh_tolerance <= 0 || result.mesh_error <= options.mesh_tolerance;
    if (!result.succeeded() || fine_enough || result.refinements >= options.max_refinements) {
      return result;
    }
    const int order = 2 * options.scheme.num_nodes() - 2;
    for (std::size_t p = 0; p < meshes.size(); ++p) {
      meshes[p] = Refined(meshes[p], errors[p], options.mesh_tolerance, order);
    }
  }
}

}  // namespace possibility::collocation
