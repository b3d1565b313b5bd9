#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/solver/solver.h"
#include "collocation/transcription/multipliers.h"
#include "collocation/transcription/program_functions.h"
#include "collocation/transcription/trajectory.h"
#include "collocation/transcription/transcription_scheme.h"
#include "collocation/transcription/variable_layout.h"

namespace possibility::collocation {

/// The nonlinear program of a problem, for a scheme and a mesh per phase. The problem must outlive
/// it. Bounds between the knots of compressed schemes are rows; all other bounds are bounds of
/// variables.
/// @throws std::invalid_argument that names phase and quantity: no duration, no coordinates, bounds
/// that contradict each other at some knot, a mesh that does not ascend from 0 to 1, a quantity
/// that nothing uses (CheckEverythingIsUsed).
class Transcription : public NonlinearProgram {
 public:
  /// `cancellation` is asked from time to time. `threads`: as OptimalControlOptions::threads.
  /// @throws Cancelled.
  Transcription(const OptimalControlProblem& problem, const TranscriptionScheme& scheme,
                std::vector<Mesh> meshes, const CancellationToken& cancellation = {},
                int threads = 1);
  Transcription(const Transcription&) = delete;
  Transcription& operator=(const Transcription&) = delete;

  int num_variables() const override { return layout_.num_variables(); }
  int num_constraints() const override { return functions_.num_rows(); }
  const Eigen::VectorXd& lower() const override { return layout_.lower(); }
  const Eigen::VectorXd& upper() const override { return layout_.upper(); }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }
  /// @throws std::runtime_error naming the cost and the point if one is not finite.
  double Objective(const Eigen::VectorXd& x) override;
  /// @throws std::runtime_error as Objective does.
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override;
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override;
  const SparsityPattern& jacobian_pattern() const override { return functions_.jacobian_pattern(); }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override;
  const SparsityPattern& hessian_pattern() const override { return functions_.hessian_pattern(); }
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override;
  std::string VariableName(int variable) const override;
  std::string ConstraintName(int constraint) const override;

  /// The constraint's name without the point where it holds: "swing: knee".
  std::string ConstraintGroup(int constraint) const;
  std::string VariableGroup(int variable) const;  ///< likewise
  double ConstraintScale(int constraint) const override {
    return functions_.row_scales().at(constraint);
  }
  double VariableScale(int variable) const override { return layout_.scales().at(variable); }
  /// Phases follow each other; each takes one unit.
  std::vector<double> VariableTimes() const override { return layout_.TimesOf(layout_.names()); }
  std::vector<double> ConstraintTimes() const override {
    return layout_.TimesOf(functions_.row_names());
  }

  /// The problem's own guesses.
  Eigen::VectorXd InitialGuess() const;
  /// Samples a trajectory of the same problem, on any mesh and scheme, at this program's points.
  /// @throws std::invalid_argument naming the phase that has another number of quantities.
  Eigen::VectorXd GuessFrom(const Trajectory& trajectory) const;
  Trajectory TrajectoryOf(const Eigen::VectorXd& x) const;

  /// A sentence for each element of a function's derivatives that disagrees with differences at x
  /// (wrong_derivatives.h). @throws Cancelled.
  std::vector<std::string> WrongDerivatives(const Eigen::VectorXd& x,
                                            const CancellationToken& cancellation = {}) const;

  Multipliers MultipliersOf(const SolverResult& solution) const;
  /// Adds to a guess the multipliers of a solution with this program's scheme, interpolated if the
  /// mesh differs. False, with nothing added, if the scheme differs or a row is new.
  bool AddMultipliers(const Multipliers& multipliers, const Trajectory& trajectory,
                      SolverGuess* guess) const;

 private:
  void AddDefects(int phase, const CancellationToken& cancellation);
  void AddControlRates(int phase);
  /// Refuses what asks for controls without jumps at knots, if the scheme's jump.
  void CheckControls() const;
  /// Bounds at the ends of a phase of what is no variable there.
  void AddBoundsOfEnds(int phase);
  void AddPathConstraints(int phase, const CancellationToken& cancellation);
  void AddIntegrals(int phase, const CancellationToken& cancellation);
  /// What a point of a phase adds to an integral.
  CostTerm IntegralTerm(int phase, int point, const std::shared_ptr<Function>& function,
                        const std::vector<Variable>& variables, double weight) const;
  void AddInstants();

  VariableLayout layout_;
  ProgramFunctions functions_;  // keeps a reference to layout_
  Eigen::VectorXd constraint_lower_, constraint_upper_;
};

}  // namespace possibility::collocation
