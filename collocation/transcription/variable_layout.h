#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/problem/polynomial_form.h"
#include "collocation/transcription/placed_name.h"
#include "collocation/transcription/trajectory.h"
#include "collocation/transcription/transcription_scheme.h"

namespace possibility::collocation {

/// A point of a phase's mesh: a knot, or a node of the scheme between two knots.
struct LayoutPoint {
  int interval;
  int node;
  double share;  ///< of the phase's duration
  bool is_knot;
  /// Whether the highest derivatives and the controls are variables here. Otherwise they are values
  /// of the polynomial of the interval that begins here, or at the last knot of that which ends.
  bool has_values;
};

/// Indices of a phase's quantities among the program's variables.
struct PhaseLayout {
  Mesh mesh;
  std::vector<LayoutPoint> points;
  /// By point, coordinate, order; -1: derived from other variables.
  std::vector<std::vector<std::vector<int>>> coordinates;
  std::vector<std::vector<int>> controls;  ///< by point, control; -1: likewise
  int duration = -1;                       ///< -1: fixed
  double fixed_duration = 0;               ///< s
};

/// Whether something that holds `at` holds at a point of `num_points`.
bool HoldsAt(At at, int point, int num_points);

/// Whether a constraint is imposed at a point of a phase: at those with values, at knots, or at the
/// end for which it was asked.
bool IsImposedAt(const Phase::PathConstraint& constraint, const std::vector<LayoutPoint>& points,
                 int point);

/// The variables of the nonlinear program of a problem, for a scheme and a mesh per phase: which
/// quantity each one is, its scale and its bounds. Gives any quantity at any point of the mesh as a
/// form in the variables. The problem must outlive it.
/// @throws std::invalid_argument that names phase and quantity: no duration, no coordinates, bounds
/// that contradict each other at some point, a mesh that does not ascend from 0 to 1.
class VariableLayout {
 public:
  VariableLayout(const OptimalControlProblem& problem, const TranscriptionScheme& scheme,
                 std::vector<Mesh> meshes);

  const OptimalControlProblem& problem() const { return problem_; }
  const TranscriptionScheme& scheme() const { return scheme_; }
  const PhaseLayout& phase(int index) const { return phases_[index]; }
  /// The variable of each parameter of the problem.
  const std::vector<int>& parameters() const { return parameters_; }

  int num_variables() const { return static_cast<int>(scales_.size()); }
  const std::vector<PlacedName>& names() const { return names_; }
  const std::vector<double>& scales() const { return scales_; }
  /// Bounds of the variables divided by their scales.
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }

  /// From variables divided by their scales to the problem's own units.
  Eigen::VectorXd Unscaled(const Eigen::VectorXd& x) const { return x.cwiseProduct(scale_vector_); }
  const Eigen::VectorXd& scale_vector() const { return scale_vector_; }
  /// From the problem's own units to variables divided by their scales, within their bounds.
  Eigen::VectorXd ScaledWithinBounds(const Eigen::VectorXd& x) const {
    return x.cwiseQuotient(scale_vector_).cwiseMax(lower_).cwiseMin(upper_);
  }

  /// A variable at a point of a phase, as a form in the variables in the problem's own units; so
  /// are the next two.
  PolynomialForm FormOf(Variable variable, int phase, int point) const;
  /// A coordinate's derivative of an order below the phase's at a node of an interval, by
  /// integration from the interval's first knot.
  PolynomialForm IntegralForm(int phase, int interval, int node, int coordinate, int order) const;
  PolynomialForm InstantForm(const VariableAt& instant) const;
  /// The slope of a control, per second, at a share of an interval.
  PolynomialForm ControlRateForm(int phase, int interval, double share, int control) const;
  /// An integral over a phase has the phase's duration times this as its weight.
  PolynomialForm DurationForm(int phase, double factor) const;

  Bounds BoundsAt(const Phase::Quantity& quantity, int phase, int point) const;
  /// s; `x` in the problem's own units.
  double DurationOf(int phase, const Eigen::VectorXd& x) const;
  /// For messages: "knot 3", "interval 3, node 1".
  std::string KnotName(int phase, int point) const;
  /// For messages: "swing, knot 3 (t = 0.5 of the duration): knee".
  std::string FullName(const PlacedName& name) const;
  /// The same without the point: "swing: knee".
  std::string GroupOf(const PlacedName& name) const;
  /// By name: its phase's index plus its point's share of the phase; NaN if it is of no point.
  std::vector<double> TimesOf(const std::vector<PlacedName>& names) const;

 private:
  int AddVariable(double scale, Bounds bounds, PlacedName name);
  void LayOut(int phase);
  void LayOutPoint(int phase, int point);
  /// The variable of the earlier phase that the quantity at the start of this one continues, with
  /// its bounds intersected; a new variable if it continues none.
  int AddContinuing(Variable variable, int point);
  std::string PointName(int phase, int point) const;
  /// IntegralForm at a share of the interval, of any order; at the phase's order it is the
  /// polynomial itself.
  PolynomialForm InterpolantForm(int phase, int interval, double share, int coordinate,
                                 int order) const;
  PolynomialForm ControlForm(int phase, int interval, double share, int control) const;
  PolynomialForm FormAtShare(Variable variable, int phase, double share) const;
  PolynomialForm TimeForm(int phase, double share) const;

  const OptimalControlProblem& problem_;
  TranscriptionScheme scheme_;
  std::vector<PhaseLayout> phases_;
  std::vector<int> parameters_;
  std::vector<PlacedName> names_;
  std::vector<double> scales_, lowers_, uppers_;  // by variable; bounds not scaled
  Eigen::VectorXd scale_vector_, lower_, upper_;
};

}  // namespace possibility::collocation
