#include "experiments/regression/regression_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "collocation/solver/status_name.h"
#include "experiments/regression/work_precision.h"

namespace possibility::experiments {
namespace {

using collocation::OptimalControlResult;
using collocation::SolverStatus;
using nlohmann::ordered_json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double RelativeError(double objective, double known) {
  const double error = std::abs(objective - known);
  return known == 0 ? error : error / std::abs(known);
}

/// Finds the known optimum nearest to the objective, in units of each optimum's tolerance, so that
/// of two close optima the one reached is found.
void LookUp(const RegressionProblem& problem, RegressionRecord* record) {
  double nearest = std::numeric_limits<double>::infinity();
  record->relative_error = kNaN;
  for (const KnownOptimum& optimum : problem.optima) {
    const double error = RelativeError(record->objective, optimum.objective);
    const double tolerances = error / optimum.tolerance;
    if (!(tolerances < nearest)) continue;
    nearest = tolerances;
    record->nearest = optimum;
    record->relative_error = error;
  }
}

void CopyResult(const OptimalControlResult& result, RegressionRecord* record) {
  record->status = collocation::StatusName(result.status);
  record->message = result.message;
  record->objective = result.objective;
  record->iterations = result.iterations;
  record->evaluations = result.evaluations;
  for (const collocation::PhaseTrajectory& phase : result.trajectory.phases) {
    record->intervals.push_back(static_cast<int>(phase.mesh.size()) - 1);
  }
  record->refinements = result.refinements;
  record->mesh_error = result.mesh_error;
  record->stationary_point = result.stationary_point;
  record->seconds = result.times;
  record->variables = static_cast<int>(result.solver.x.size());
  record->constraints = static_cast<int>(result.solver.constraints.size());
}

int Sum(const std::vector<int>& numbers) {
  int sum = 0;
  for (const int number : numbers) sum += number;
  return sum;
}

/// ", saddle", or nothing if it is not known.
std::string PointText(const RegressionRecord& record) {
  if (record.stationary_point == collocation::StationaryPoint::kUnknown) return "";
  return fmt::format(", {}", StationaryPointName(record.stationary_point));
}

std::string Line(const RegressionRecord& record) {
  const std::string verdict = record.within_tolerance ? record.nearest.name
                              : record.status == "solved" || record.status == "acceptable"
                                  ? fmt::format("MISSES {}", record.nearest.name)
                                  : "FAILS: " + record.message;
  return fmt::format("{:<26}{:<11}{:>17.10g}{:>10.1e}{:>6}{:>6}{:>9.4f} s  {}{}\n", record.name,
                     record.status, record.objective, record.relative_error, record.iterations,
                     Sum(record.intervals), record.seconds.total, verdict, PointText(record));
}

}  // namespace

ordered_json RegressionOptions::Json() const {
  const bool ldlt = linear_solver == collocation::LinearSolver::kSparseLdlt;
  const bool exact = hessian == collocation::HessianMode::kExact;
  return {{"scheme", scheme ? ordered_json(scheme->name) : ordered_json(nullptr)},
          {"intervals", intervals ? ordered_json(*intervals) : ordered_json(nullptr)},
          {"solver", solver ? solver->name() : collocation::IpoptSolver().name()},
          {"linear_solver", ldlt ? "ldlt" : "mumps"},
          {"hessian", exact ? "exact" : "limited_memory"},
          {"coarse_first", coarse_first}};
}

collocation::OptimalControlOptions RegressionOptions::For(const RegressionProblem& problem) const {
  collocation::OptimalControlOptions options;
  options.scheme = scheme.value_or(problem.scheme);
  options.intervals = {intervals.value_or(problem.intervals)};
  options.mesh_tolerance = problem.mesh_tolerance;
  options.solver.linear_solver = linear_solver;
  options.solver.hessian = hessian;
  options.solver.time_limit = time_limit;
  options.nonlinear_solver = solver;
  options.second_order_check = second_order_check;
  options.coarse_first = coarse_first;
  return options;
}

RegressionRecord RunProblem(const RegressionProblem& problem, const RegressionOptions& options) {
  RegressionRecord record;
  record.name = problem.name;
  record.source = problem.source;
  const collocation::OptimalControlOptions solve = options.For(problem);
  record.scheme = solve.scheme.name;
  try {
    const auto posed = problem.build();
    const OptimalControlResult result = SolveOptimalControl(*posed, solve);
    CopyResult(result, &record);
    record.solution = Store(*posed, result);
    LookUp(problem, &record);
    record.within_tolerance =
        result.succeeded() && record.relative_error <= record.nearest.tolerance;
  } catch (const std::exception& error) {
    record.status = "error";
    record.message = error.what();
    record.objective = record.relative_error = record.mesh_error = kNaN;
  }
  return record;
}

RegressionReport RunRegression(const std::vector<RegressionProblem>& problems,
                               const RegressionOptions& options,
                               const std::function<void(int, const std::string&)>& progress) {
  RegressionReport report{ThisEnvironment(), options, {}};
  for (const RegressionProblem& problem : problems) {
    const auto done = static_cast<int>(report.problems.size());
    progress(done, problem.name);
    RegressionRecord record = RunProblem(problem, options);
    if (options.work_precision) {
      record.work_precision = MeasureWorkPrecision(problem, options, [&](int mesh, int meshes) {
        progress(done, fmt::format("{}, mesh {} of {}", problem.name, mesh + 1, meshes));
      });
    }
    report.problems.push_back(std::move(record));
  }
  return report;
}

ordered_json WorkPrecisionPoint::Json() const {
  return {{"scheme", scheme},         {"intervals", intervals},
          {"status", status},         {"relative_error", relative_error},
          {"iterations", iterations}, {"seconds", seconds}};
}

ordered_json RegressionRecord::Json() const {
  ordered_json json = {
      {"name", name},
      {"source", source},
      {"status", status},
      {"message", message},
      {"objective", objective},
      {"optimum", within_tolerance ? ordered_json(nearest.name) : ordered_json(nullptr)},
      {"nearest_optimum",
       {{"name", nearest.name},
        {"objective", nearest.objective},
        {"tolerance", nearest.tolerance}}},
      {"relative_error", relative_error},
      {"within_tolerance", within_tolerance},
      {"stationary_point", StationaryPointName(stationary_point)},
      {"iterations", iterations},
      {"evaluations",
       {{"objective", evaluations.objective},
        {"gradient", evaluations.gradient},
        {"constraints", evaluations.constraints},
        {"jacobian", evaluations.jacobian},
        {"hessian", evaluations.hessian}}},
      {"mesh",
       {{"scheme", scheme},
        {"intervals", intervals},
        {"refinements", refinements},
        {"error", mesh_error}}},
      {"seconds",
       {{"total", seconds.total},
        {"functions", seconds.functions},
        {"derivatives", seconds.derivatives},
        {"factorisation", seconds.factorisation},
        {"back_solves", seconds.back_solves},
        {"second_order", seconds.second_order},
        {"rest", seconds.rest}}},
      {"variables", variables},
      {"constraints", constraints}};
  if (work_precision.empty()) return json;
  json["work_precision"] = ordered_json::array();
  for (const WorkPrecisionPoint& point : work_precision) {
    json["work_precision"].push_back(point.Json());
  }
  return json;
}

std::vector<std::string> RegressionReport::Failures() const {
  std::vector<std::string> names;
  for (const RegressionRecord& record : problems) {
    if (!record.within_tolerance) names.push_back(record.name);
  }
  return names;
}

ordered_json RegressionReport::Json() const {
  ordered_json json = {{"format", "possibility-regress/1"},
                       {"environment", environment.Json()},
                       {"options", options.Json()},
                       {"problems", ordered_json::array()}};
  for (const RegressionRecord& record : problems) json["problems"].push_back(record.Json());
  return json;
}

std::string RegressionReport::Text() const {
  std::string text = fmt::format("{:<26}{:<11}{:>17}{:>10}{:>6}{:>6}{:>11}  {}\n", "problem",
                                 "status", "objective", "error", "iter", "mesh", "time", "optimum");
  double seconds = 0, linear_algebra = 0;
  int minima = 0;
  for (const RegressionRecord& record : problems) {
    text += Line(record);
    minima += record.stationary_point == collocation::StationaryPoint::kMinimum;
    seconds += record.seconds.total;
    linear_algebra += record.seconds.factorisation + record.seconds.back_solves;
  }
  const std::size_t failures = Failures().size();
  const std::string proved =
      options.second_order_check ? fmt::format(", {} proved minima", minima) : "";
  return text +
         fmt::format("{} of {} within tolerance{}; {:.2f} s, {:.2f} s of it linear algebra\n",
                     problems.size() - failures, problems.size(), proved, seconds, linear_algebra);
}

}  // namespace possibility::experiments
