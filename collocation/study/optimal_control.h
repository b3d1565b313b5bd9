#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collocation/diagnosis/stationary_point.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/solver/nonlinear_solver.h"
#include "collocation/solver/solver.h"
#include "collocation/study/control_jumps.h"
#include "collocation/study/mesh_error.h"
#include "collocation/study/stored_solution.h"
#include "collocation/transcription/transcription.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

struct OptimalControlOptions {
  TranscriptionScheme scheme = HermiteSimpson();
  /// Initial number of intervals per phase: one number for all phases or one for each.
  std::vector<int> intervals = {20};
  /// Initial knots per phase, in place of `intervals`; empty: uniform.
  std::vector<Mesh> meshes;
  /// A program of more than 1200 variables is first solved on every fifth knot of its mesh, and
  /// that one in the same way (nested iteration). Motion and multipliers are where the solve on the
  /// mesh itself starts; if the coarse one fails, it starts from the guesses. Without effect if a
  /// motion is given to start from.
  bool coarse_first = true;
  /// The mesh is refined until the error between the knots is below this; 0: never.
  double mesh_tolerance = 0;
  /// When the mesh is refined, neighbouring intervals whose errors are far below mesh_tolerance
  /// become one.
  bool coarsen = false;
  /// The mesh gets knots close to jumps of controls until each jump lies between two knots that are
  /// no farther apart than this share of the phase: for bang-bang and singular controls with the
  /// trapezoidal scheme. 0: never.
  double jump_tolerance = 0;
  int max_refinements = 6;
  /// Compares the derivatives of all functions with differences at the starting point, at the
  /// first, the middle and the last node of each. If one is wrong, nothing is solved, and the
  /// message names function, phase, knot, output and argument.
  bool check_derivatives = false;
  /// If the objective proves much smaller than solver.objective_size, the problem is solved again
  /// with its true size: to the solver's tolerance any motion would be the best.
  SolverOptions solver;
  /// Threads that evaluate constraints, those of different functions at once. Functions that share
  /// anything they write must say so (Function::Parts). The same solution, but for rounding, as
  /// with one; with several, their number does not matter.
  int threads = 1;
  /// What solves the nonlinear programs; null: Ipopt. Must outlive the call.
  const NonlinearSolver* nonlinear_solver = nullptr;
  /// After a successful solve, finds out whether the motion is a minimum or a saddle
  /// (ClassifyStationaryPoint): `stationary_point` and, for a saddle, `message`.
  bool second_order_check = false;
  /// If no motion meets the constraints, a second solve finds out which of them stand against each
  /// other (FindConflict). If it meets them all after all, the problem is solved again from there.
  bool explain_infeasible = false;
};

/// Distance of a named constraint from its bounds at its worst point.
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
  /// By constraint name without point: worst violation of each constraint.
  std::map<std::string, ConstraintViolation> violations;
  /// With explain_infeasible, for a problem that is infeasible: what cannot hold together, the
  /// heaviest first: "move: force is at most 1 (21 points)". Empty otherwise.
  std::vector<std::string> conflict;
  /// With second_order_check, for a problem that was solved; otherwise kUnknown.
  StationaryPoint stationary_point = StationaryPoint::kUnknown;
  /// For the last mesh: the greatest error between the knots. For a cancelled solve, multipliers,
  /// violations and error (NaN) are not computed. If it was cancelled while its program was built,
  /// there is no trajectory.
  double mesh_error = 0;
  MeshError mesh_errors;  ///< the same by kind
  /// With jump_tolerance: the jumps of controls on the last mesh, by phase.
  std::vector<std::vector<ControlJump>> jumps;
  int refinements = 0;
  SolverResult solver;            ///< of the last mesh
  SolverTimes times;              ///< of all meshes together, coarse ones too
  int iterations = 0;             ///< of all meshes together
  SolverEvaluations evaluations;  ///< of all meshes together

  bool succeeded() const {
    return status == SolverStatus::kSolved || status == SolverStatus::kAcceptable;
  }
  /// trajectory.Value: a variable at a time, s.
  double Value(const Variable& variable, double time) const {
    return trajectory.Value(variable, time);
  }
};

/// Transcribes and solves. If requested, refines the mesh and solves again from the last solution
/// and its multipliers.
/// `guess`: starting point in place of the problem's own guesses.
/// @throws std::invalid_argument as Transcription, CheckScales and Solve do.
OptimalControlResult SolveOptimalControl(
    const OptimalControlProblem& problem, const OptimalControlOptions& options = {},
    const std::optional<Trajectory>& guess = std::nullopt,
    const CancellationToken& cancellation = {},
    const std::function<void(const SolverIteration&)>& log = {});

/// The same, from a solution of a neighbouring problem (another distance, another bound). If the
/// scheme is the stored one and every row has its multipliers, the solver starts with motion and
/// multipliers (`dual_start`), otherwise with the motion alone. Both are interpolated if the mesh
/// differs. To use the stored mesh, set options.meshes = start.Meshes().
/// @throws std::invalid_argument also if the problem has other phases or quantities; names the
/// first difference.
OptimalControlResult SolveOptimalControl(
    const OptimalControlProblem& problem, const StoredSolution& start,
    const OptimalControlOptions& options = {}, const CancellationToken& cancellation = {},
    const std::function<void(const SolverIteration&)>& log = {});

/// The result in the form from which a later solve can start.
StoredSolution Store(const OptimalControlProblem& problem, const OptimalControlResult& result);

}  // namespace possibility::collocation
