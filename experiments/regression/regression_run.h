#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/problems/regression_problems.h"
#include "experiments/support/run_environment.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

/// Changes of a run to the defaults.
struct RegressionOptions {
  std::optional<collocation::TranscriptionScheme> scheme;  ///< none: as each problem says
  std::optional<int> intervals;  ///< initial, per phase; none: as each problem says
  collocation::LinearSolver linear_solver = collocation::LinearSolver::kSparseLdlt;
  collocation::HessianMode hessian = collocation::HessianMode::kExact;
  const collocation::NonlinearSolver* solver = nullptr;  ///< null: Ipopt
  double time_limit = 0;                                 ///< s for each mesh; 0: none
  bool second_order_check = false;
  bool coarse_first = true;     ///< large problems are first solved on coarser meshes
  bool work_precision = false;  ///< measured for each problem; takes 20 to 70 times as long

  nlohmann::ordered_json Json() const;
  /// Options for one problem.
  collocation::OptimalControlOptions For(const RegressionProblem& problem) const;
};

/// One solve on a fixed mesh (work_precision.h).
struct WorkPrecisionPoint {
  std::string scheme;
  int intervals = 0;  ///< of each phase
  std::string status;
  double relative_error = 0;  ///< to the known optimum nearest to this solve's objective
  int iterations = 0;
  double seconds = 0;

  nlohmann::ordered_json Json() const;
};

/// Result of one problem.
struct RegressionRecord {
  std::string name;
  std::string source;
  std::string scheme;
  std::string status;  ///< "solved", ...; "error" if it could not be posed
  std::string message;
  double objective = 0;
  KnownOptimum nearest;       ///< among the known optima
  double relative_error = 0;  ///< to `nearest`; absolute if its value is 0
  bool within_tolerance = false;
  collocation::StationaryPoint stationary_point = collocation::StationaryPoint::kUnknown;
  int iterations = 0;
  collocation::SolverEvaluations evaluations;
  std::vector<int> intervals;  ///< of each phase, final
  int refinements = 0;
  double mesh_error = 0;
  collocation::SolverTimes seconds;
  int variables = 0;
  int constraints = 0;
  std::vector<WorkPrecisionPoint> work_precision;  ///< by scheme, then mesh; empty: not measured
  collocation::StoredSolution solution;            ///< no phases if there is none; not in the JSON

  nlohmann::ordered_json Json() const;
};

struct RegressionReport {
  RunEnvironment environment;
  RegressionOptions options;
  std::vector<RegressionRecord> problems;

  /// Names of problems that were not solved or missed every known optimum.
  std::vector<std::string> Failures() const;
  /// docs/command_line.md, "possibility-regress/1".
  nlohmann::ordered_json Json() const;
  /// One line per problem and a summary.
  std::string Text() const;
};

/// Solves one problem from its stated guess and compares with its known optima. Exceptions of the
/// problem are recorded.
RegressionRecord RunProblem(const RegressionProblem& problem, const RegressionOptions& options);

/// Solves the problems one after another. Before each, `progress` gets the number done and the
/// problem's name; for work and precision before each mesh, with the mesh.
RegressionReport RunRegression(const std::vector<RegressionProblem>& problems,
                               const RegressionOptions& options,
                               const std::function<void(int, const std::string&)>& progress);

}  // namespace possibility::experiments
