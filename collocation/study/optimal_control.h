#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/solver/solver.h"
#include "collocation/study/stored_solution.h"
#include "collocation/transcription/transcription.h"

namespace possibility::collocation {

struct OptimalControlOptions {
  TranscriptionScheme scheme = HermiteSimpson();
  /// Intervals per phase to begin with: one number for all phases or one for each.
  std::vector<int> intervals = {20};
  /// Knots per phase to begin with, in place of `intervals`; empty: uniform.
  std::vector<Mesh> meshes;
  /// The mesh is refined until the error between the knots is below this; 0: never.
  double mesh_tolerance = 0;
  int max_refinements = 6;
  SolverOptions solver;
};

/// How far a named constraint is from its bounds at the worst of its points.
struct ConstraintViolation {
  double amount = 0;  ///< in the constraint's own unit
  std::string where;  ///< "swing, knot 3 (t = 0.3 of the duration): knee[1]"
};

struct OptimalControlResult {
  SolverStatus status = SolverStatus::kFailed;
  std::string message;
  double objective = 0;
  Trajectory trajectory;
  Multipliers multipliers;  ///< of the last mesh
  bool dual_start = false;  ///< the first solve started with multipliers, not with a motion alone
  /// By constraint name without point: every constraint with its worst violation.
  std::map<std::string, ConstraintViolation> violations;
  /// Of the last mesh: the error between the knots of each phase (MeshErrors). Of a solve that
  /// was cancelled neither multipliers nor violations nor error (NaN) are computed, and if it was
  /// cancelled while its program was built, there is no trajectory.
  double mesh_error = 0;
  int refinements = 0;
  SolverResult solver;            ///< of the last mesh
  SolverTimes times;              ///< of all meshes together
  int iterations = 0;             ///< of all meshes together
  SolverEvaluations evaluations;  ///< of all meshes together

  bool succeeded() const {
    return status == SolverStatus::kSolved || status == SolverStatus::kAcceptable;
  }
};

/// Transcribes, solves and, if so told, refines the mesh and solves again from the last solution
/// and its multipliers.
/// `guess`: where to start in place of the problem's own guesses.
/// @throws std::invalid_argument as Transcription and Solve do.
OptimalControlResult SolveOptimalControl(
    const OptimalControlProblem& problem, const OptimalControlOptions& options = {},
    const std::optional<Trajectory>& guess = std::nullopt, SolveControl* control = nullptr,
    const std::function<void(const SolverIteration&)>& log = {});

/// The same, from a solution of a neighbouring problem (another distance, another bound). With the
/// scheme it was stored with, and if every row has its multipliers, it starts the solver with
/// motion and multipliers (`dual_start`), else with the motion alone; either is interpolated where
/// the mesh is another. options.meshes = start.Meshes() takes its mesh over.
/// @throws std::invalid_argument also if the problem has other phases or quantities: the first
/// difference.
OptimalControlResult SolveOptimalControl(
    const OptimalControlProblem& problem, const StoredSolution& start,
    const OptimalControlOptions& options = {}, SolveControl* control = nullptr,
    const std::function<void(const SolverIteration&)>& log = {});

/// What a later solve can start from.
StoredSolution Store(const OptimalControlProblem& problem, const OptimalControlResult& result);

}  // namespace possibility::collocation
