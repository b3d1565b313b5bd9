#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collocation/problem/function_block.h"
#include "collocation/problem/nonlinear_program.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/solver/solver.h"
#include "collocation/transcription/multipliers.h"
#include "collocation/transcription/trajectory.h"
#include "collocation/transcription/transcription_scheme.h"

namespace possibility::collocation {

/// The nonlinear program of a problem, for a scheme and a mesh per phase. The problem must outlive
/// it. Bounds between the knots of compressed schemes are rows; all other bounds are bounds of
/// variables.
/// @throws std::invalid_argument that names phase and quantity: no duration, no coordinates, bounds
/// that contradict each other at some knot, a mesh that does not ascend from 0 to 1.
class Transcription : public NonlinearProgram {
 public:
  /// Called from time to time while a program is built. May throw, which abandons the program.
  using Interrupt = std::function<void()>;

  Transcription(const OptimalControlProblem& problem, const TranscriptionScheme& scheme,
                std::vector<Mesh> meshes, const Interrupt& interrupt = {});

  int num_variables() const override { return static_cast<int>(lower_.size()); }
  int num_constraints() const override { return static_cast<int>(constraint_lower_.size()); }
  const Eigen::VectorXd& lower() const override { return lower_; }
  const Eigen::VectorXd& upper() const override { return upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }
  /// @throws std::runtime_error naming the cost and the point if one is not finite.
  double Objective(const Eigen::VectorXd& x) override;
  /// @throws std::runtime_error as Objective does.
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override;
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override;
  const SparsityPattern& jacobian_pattern() const override { return jacobian_.pattern(); }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override;
  const SparsityPattern& hessian_pattern() const override { return hessian_.pattern(); }
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override;
  std::string VariableName(int variable) const override;
  std::string ConstraintName(int constraint) const override;

  /// The constraint's name without the point where it holds: "swing: knee".
  std::string ConstraintGroup(int constraint) const;
  double ConstraintScale(int constraint) const override { return row_scales_.at(constraint); }
  double VariableScale(int variable) const override { return scales_.at(variable); }

  /// The problem's own guesses.
  Eigen::VectorXd InitialGuess() const;
  /// Samples a trajectory of the same problem, on any mesh and scheme, at this program's points.
  /// @throws std::invalid_argument naming the phase that has another number of quantities.
  Eigen::VectorXd GuessFrom(const Trajectory& trajectory) const;
  Trajectory TrajectoryOf(const Eigen::VectorXd& x) const;

  Multipliers MultipliersOf(const SolverResult& solution) const;
  /// Adds to a guess the multipliers of a solution with this program's scheme, interpolated if the
  /// mesh differs. False, with nothing added, if the scheme differs or a row is new.
  bool AddMultipliers(const Multipliers& multipliers, const Trajectory& trajectory,
                      SolverGuess* guess) const;

 private:
  struct Point {
    int interval;
    int node;
    double share;  ///< of the phase's duration
    bool is_knot;
  };
  /// Indices of a phase's quantities among the program's variables.
  struct PhaseLayout {
    Mesh mesh;
    std::vector<Point> points;
    std::vector<std::vector<std::vector<int>>>
        coordinates;                         // point, coordinate, order; -1: derived
    std::vector<std::vector<int>> controls;  // point, control
    int duration = -1;                       // -1: fixed
    double fixed_duration = 0;
  };
  /// One linear or bilinear row.
  struct FormRow {
    PolynomialForm form;
    double scale;
    std::vector<int> jacobian_slots, hessian_slots;
  };
  /// The name and place of a variable or a row.
  struct PlacedName {
    int phase;  // -1: of no phase
    int point;
    std::string name;
    int output;
    bool is_defect = false;
  };

  int AddVariable(double scale, Bounds bounds, PlacedName name);
  void LayOut(int phase);
  void LayOutPoint(int phase, int point);
  void ShareContinued();
  Bounds BoundsAt(const Phase::Quantity& quantity, int phase, int point) const;
  static bool Holds(At at, int point, int num_points);
  std::string PointName(int phase, int point) const;
  std::string FullName(const PlacedName& name) const;
  [[noreturn]] void FailForGradient(const Eigen::VectorXd& unscaled);
  void CheckFits(const Trajectory& trajectory) const;
  bool HasSchemeOf(const Trajectory& trajectory) const;
  /// Multipliers of variables or rows, scaled. None if `all` is set and one is unknown.
  std::optional<Eigen::VectorXd> Transferred(const std::vector<MultiplierSeries>& series,
                                             const Trajectory& from,
                                             const std::vector<PlacedName>& names,
                                             const std::vector<double>& scales, bool all) const;
  static std::vector<MultiplierSeries> SeriesOf(const std::vector<PlacedName>& names,
                                                const std::vector<double>& scales,
                                                const Eigen::VectorXd& multipliers);
  PolynomialForm FormOf(Variable variable, int phase, int point) const;
  PolynomialForm Integrated(int phase, int interval, int node, int coordinate, int order) const;
  PolynomialForm TimeForm(int phase, double share) const;
  PolynomialForm EndForm(const EndVariable& end) const;
  double DurationOf(int phase, const Eigen::VectorXd& x) const;
  void AddDefects(int phase, const Interrupt& interrupt);
  void AddPathConstraints(int phase, const Interrupt& interrupt);
  void AddIntegralCosts(int phase, const Interrupt& interrupt);
  void AddEnds();
  void AddFormRow(PolynomialForm form, double scale, Bounds bounds, PlacedName name);
  void AddBlock(FunctionBlock block, const std::vector<Bounds>& bounds,
                const Eigen::VectorXd& scales, PlacedName name);
  double GuessOf(const Phase& phase, Variable variable, double share, double duration) const;
  Eigen::VectorXd Scaled(const Eigen::VectorXd& x) const { return x.cwiseProduct(scale_); }

  const OptimalControlProblem& problem_;
  TranscriptionScheme scheme_;
  std::vector<PhaseLayout> layouts_;
  std::vector<int> parameters_;
  std::vector<double> scales_, lowers_, uppers_, row_lowers_, row_uppers_;  // while being built
  std::vector<double> row_scales_;
  Eigen::VectorXd ones_;  // point at which forms are visited to find their variables
  Eigen::VectorXd scale_, lower_, upper_, constraint_lower_, constraint_upper_;
  std::vector<PlacedName> variable_names_, row_names_, cost_names_;
  std::vector<FormRow> form_rows_;  // the first rows
  std::vector<FunctionBlock> blocks_;
  std::vector<FunctionBlock> costs_;
  ElementSlots jacobian_, hessian_;
};

}  // namespace possibility::collocation
