#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collocation/problem/bounds.h"
#include "collocation/problem/function.h"

namespace possibility::collocation {

enum class VariableKind { kCoordinate, kControl, kParameter, kDuration, kTime, kShare };

/// Identifies one quantity of one problem. Functions take variables as arguments, and bounds apply
/// to them. Variables come from phases and problems, which refuse those of others.
struct Variable {
  VariableKind kind = VariableKind::kCoordinate;
  int phase = -1;            ///< -1: a parameter of the problem
  int index = 0;             ///< among its kind in the phase
  int order = 0;             ///< for a coordinate: how often it is differentiated
  std::int64_t problem = 0;  ///< number of the problem within the process; 0: of none

  bool operator==(const Variable&) const = default;
};

/// The mesh points of a phase at which something holds.
enum class At {
  kEverywhere,
  kStart,       ///< the first knot
  kEnd,         ///< the last knot
  kAfterStart,  ///< everywhere but the first knot
  kBeforeEnd,   ///< everywhere but the last knot
  kInside       ///< everywhere but both
};

/// One quantity at one instant: at an end of its phase (At::kStart or kEnd), or at a share of the
/// phase's duration.
struct VariableAt {
  Variable variable;
  At at = At::kStart;
  std::optional<double> share = std::nullopt;  ///< from 0 to 1; none: `at` says when
};

/// A quantity at a share of its phase's duration: on the polynomial that is transcribed, wherever
/// the mesh has its knots.
VariableAt AtShare(Variable variable, double share);

/// The names of a phase's parts, to display or store its motions.
struct PhaseNames {
  std::string phase;
  int order = 1;
  std::vector<std::string> coordinates, controls;
  std::vector<int> orders = {};  ///< by coordinate; empty: all have that of the phase

  bool operator==(const PhaseNames&) const = default;
};

class OptimalControlProblem;

/// A time interval with one system. Its coordinates y come with their derivatives up to the phase's
/// order, or up to a lower order of their own. Order 1 is for x' = f(x, u), where x' is a variable
/// beside x; order 2 is for mechanical systems in q, v and a. Transcription ties the derivatives
/// together; dynamics are one more constraint.
class Phase {
 public:
  /// A coordinate, one of its derivatives, or a control.
  struct Quantity {
    std::string name;
    double scale = 1;
    bool has_own_scale = false;  ///< that was given, not suggested
    std::vector<std::pair<At, Bounds>> bounds;
    std::function<double(double)> guess;  ///< of the share of the duration; may be empty
  };

  struct PathConstraint {
    std::string name;
    std::shared_ptr<Function> function;
    std::vector<Variable> arguments;
    std::vector<Bounds> bounds;
    At at;
    Eigen::VectorXd scales;       ///< by output
    bool has_own_scales = false;  ///< that were given, not suggested
    bool only_at_knots = false;
    bool is_dynamics = false;  ///< of SetDynamics
  };

  struct IntegralCost {
    std::string name;
    std::shared_ptr<Function> function;
    std::vector<Variable> arguments;
    double weight;
  };

  struct IntegralConstraint {
    std::string name;
    std::shared_ptr<Function> function;
    std::vector<Variable> arguments;
    Bounds bounds;
    double scale;
  };

  /// Of the time integral of the squared rate of a control.
  struct RateCost {
    int control;  ///< among `controls()`
    double weight;
  };

  struct RateBound {
    int control;  ///< among `controls()`
    Bounds bounds;
    double scale;  ///< of the rate
  };

  const std::string& name() const { return name_; }
  /// The greatest order of a coordinate.
  int order() const { return order_; }
  int OrderOf(int coordinate) const {
    return static_cast<int>(coordinates_.at(coordinate).size()) - 1;
  }
  PhaseNames Names() const;

  /// A coordinate; `scale`: its typical size, above 0. None: 1, unless SetAutomaticScales finds
  /// another.
  Variable AddCoordinate(const std::string& name, Bounds bounds = {},
                         std::optional<double> scale = std::nullopt);
  /// A coordinate of an order from 1 to the phase's: the state of a motor beside positions.
  Variable AddCoordinateOfOrder(int order, const std::string& name, Bounds bounds = {},
                                std::optional<double> scale = std::nullopt);
  /// The time derivative of a coordinate or of its derivative; it has its own bounds and scale.
  Variable Rate(Variable coordinate, int times = 1) const;
  Variable AddControl(const std::string& name, Bounds bounds = {},
                      std::optional<double> scale = std::nullopt);
  Variable duration() const { return Own(VariableKind::kDuration, 0); }
  /// Time since the beginning of the problem.
  Variable time() const { return Own(VariableKind::kTime, 0); }
  /// Share of the phase's duration that has passed, from 0 to 1.
  Variable share() const { return Own(VariableKind::kShare, 0); }

  /// s; equal bounds fix it. @throws std::invalid_argument unless 0 < lower <= upper < infinity.
  void SetDuration(Bounds bounds);
  void SetDuration(double fixed) { SetDuration({fixed, fixed}); }
  void SetScale(Variable variable, double scale);
  /// The same, unless the variable or the constraint has scales of its own. `constraint`: among
  /// constraints().
  void SuggestScale(Variable variable, double scale);
  void SuggestRowScales(int constraint, const Eigen::VectorXd& scales);

  /// Intersects the bounds of a coordinate, its derivative or a control.
  void Bound(Variable variable, Bounds bounds, At at = At::kEverywhere);
  void Fix(Variable variable, double value, At at) { Bound(variable, {value, value}, at); }

  /// y^(order) = f(arguments), one output per coordinate, each for the coordinate's order.
  void SetDynamics(std::shared_ptr<Function> f, std::vector<Variable> arguments);
  /// lower <= f(arguments) <= upper, with one Bounds per output or one for all. Dynamics in
  /// implicit form are constraints with bounds 0. `scales`: typical sizes of the outputs, one per
  /// output, one for all, or none for 1. Rows are divided by them, and so are the errors between
  /// the knots.
  void Constrain(const std::string& name, std::shared_ptr<Function> f,
                 std::vector<Variable> arguments, std::vector<Bounds> bounds,
                 At at = At::kEverywhere, std::vector<double> scales = {});
  /// The same, but only at the knots of the mesh, not at the nodes between them.
  void ConstrainKnots(const std::string& name, std::shared_ptr<Function> f,
                      std::vector<Variable> arguments, std::vector<Bounds> bounds,
                      At at = At::kEverywhere, std::vector<double> scales = {});
  /// Adds weight * the time integral of f(arguments), f of one output.
  void AddIntegralCost(const std::string& name, std::shared_ptr<Function> f,
                       std::vector<Variable> arguments, double weight = 1);
  /// Bounds the time integral of f(arguments), f of one output. `scale`: typical size of the
  /// integral. One row that has the quantities of the whole phase: a coordinate whose rate is f is
  /// quicker in long phases.
  void ConstrainIntegral(const std::string& name, std::shared_ptr<Function> f,
                         std::vector<Variable> arguments, Bounds bounds, double scale = 1);

  /// Adds weight * the time integral of the squared rate of a control. A control is a polynomial
  /// from one knot to the next, and this is the exact integral of its slope squared, per second.
  void AddRateCost(Variable control, double weight = 1);
  /// Bounds the rate of a control from knot to knot, in its unit per second; a jump between phases
  /// is no rate. Bounds of several calls intersect. Exact for controls of degree 1 and 2;
  /// polynomials of a higher degree are bounded at as many points as their slope has coefficients.
  void BoundRate(Variable control, Bounds bounds);

  /// The solver's starting point: value at s in [0, 1], the share of the phase's duration. Without
  /// a guess: the line between the values fixed at the ends, or a value within the bounds.
  void Guess(Variable variable, std::function<double(double)> value);
  void Guess(Variable variable, double value);

  // What was added, for those who read the problem.
  /// By coordinate, by order.
  const std::vector<std::vector<Quantity>>& coordinates() const { return coordinates_; }
  const std::vector<Quantity>& controls() const { return controls_; }
  const std::vector<PathConstraint>& constraints() const { return constraints_; }
  const std::vector<IntegralCost>& costs() const { return costs_; }
  const std::vector<IntegralConstraint>& integrals() const { return integrals_; }
  const std::vector<RateCost>& rate_costs() const { return rate_costs_; }
  const std::vector<RateBound>& rate_bounds() const { return rate_bounds_; }  ///< one per control
  const Bounds& duration_bounds() const { return duration_; }
  /// Of no argument that matters; may be empty.
  const std::function<double(double)>& duration_guess() const { return duration_guess_; }
  /// The coordinate, its derivative or the control.
  const Quantity& Find(Variable variable) const;
  /// The name of a quantity or parameter without the phase's.
  std::string NameOf(Variable variable) const;
  /// By index among `coordinates()` and `controls()`.
  Variable Coordinate(int index, int order = 0) const {
    return Own(VariableKind::kCoordinate, index, order);
  }
  Variable Control(int index) const { return Own(VariableKind::kControl, index); }

  /// @throws std::invalid_argument that names problem and phase.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  friend class OptimalControlProblem;
  Phase(OptimalControlProblem* problem, int index, std::string name, int order);
  Variable Own(VariableKind kind, int index, int order = 0) const;
  /// Whether a function of the phase may have the variable as its argument.
  bool Knows(Variable variable) const;
  /// Null if it is no coordinate, derivative or control of this phase.
  const Quantity* FindOrNull(Variable variable) const;
  Quantity& FindMutable(Variable variable);
  void CheckArguments(const std::string& name, const Function* f,
                      const std::vector<Variable>& arguments) const;
  void CheckNameOfConstraint(const std::string& name) const;
  /// Refuses what is no control.
  const Quantity& FindControl(Variable variable) const;

  OptimalControlProblem* problem_;
  int index_;
  std::string name_;
  int order_;
  Bounds duration_;
  std::function<double(double)> duration_guess_;
  std::vector<std::vector<Quantity>> coordinates_;
  std::vector<Quantity> controls_;
  std::vector<PathConstraint> constraints_;
  std::vector<IntegralCost> costs_;
  std::vector<IntegralConstraint> integrals_;
  std::vector<RateCost> rate_costs_;
  std::vector<RateBound> rate_bounds_;
};

/// An optimal-control problem of one or more phases in its continuous form; Transcription makes a
/// nonlinear program of it. Names are for messages and must be unique within a phase.
/// @throws std::invalid_argument that names phase and quantity for anything contradictory.
class OptimalControlProblem {
 public:
  struct Parameter {
    std::string name;
    Bounds bounds;
    double scale;
    double guess;
    bool has_own_scale;  ///< that was given, not suggested
  };

  struct LinkConstraint {
    std::string name;
    std::shared_ptr<Function> function;
    std::vector<VariableAt> arguments;
    std::vector<Bounds> bounds;
  };

  struct EndCost {
    std::string name;
    std::shared_ptr<Function> function;
    std::vector<VariableAt> arguments;
    double weight;
  };

  explicit OptimalControlProblem(std::string name);
  OptimalControlProblem(const OptimalControlProblem&) = delete;
  OptimalControlProblem& operator=(const OptimalControlProblem&) = delete;

  const std::string& name() const { return name_; }
  /// `order`: 1 or 2, of coordinates that are given no other. The reference stays valid.
  Phase& AddPhase(const std::string& name, int order = 1);
  int num_phases() const { return static_cast<int>(phases_.size()); }
  const Phase& phase(int index) const { return phases_.at(index); }
  Phase& phase(int index) { return phases_.at(index); }

  Variable AddParameter(const std::string& name, Bounds bounds = {},
                        std::optional<double> scale = std::nullopt, double guess = 0);
  /// The scale of a parameter, unless it has one of its own. `parameter`: among parameters().
  void SuggestScale(int parameter, double scale);
  std::vector<std::string> ParameterNames() const;

  /// Makes the quantity at the end of one phase and the one at the start of a later one the same
  /// variable. Bounds intersect. Quantities: coordinates and their derivatives below the phase's
  /// order, or two controls, which may jump between phases otherwise.
  void Continue(VariableAt from, VariableAt to);
  /// lower <= f(arguments) <= upper. Arguments are quantities at instants of any phases, durations
  /// and parameters.
  void Link(const std::string& name, std::shared_ptr<Function> f, std::vector<VariableAt> arguments,
            std::vector<Bounds> bounds);
  /// Adds weight * f(arguments), f of one output: what ends cost, or the distance from data at
  /// instants.
  void AddCost(const std::string& name, std::shared_ptr<Function> f,
               std::vector<VariableAt> arguments, double weight = 1);
  /// Adds weight * the quantity.
  void AddCost(VariableAt quantity, double weight = 1);

  std::string NameOf(Variable variable) const;

  /// By index among `parameters()`.
  Variable ParameterVariable(int index) const {
    return {VariableKind::kParameter, -1, index, 0, number_};
  }

  // What was added, for those who read the problem.
  const std::vector<Parameter>& parameters() const { return parameters_; }
  /// Pairs that are one variable: the end of a phase, the start of a later one.
  const std::vector<std::pair<VariableAt, VariableAt>>& continued() const { return continued_; }
  const std::vector<LinkConstraint>& links() const { return links_; }
  const std::vector<EndCost>& costs() const { return costs_; }

  /// @throws std::invalid_argument that names the problem.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  friend class Phase;
  void CheckInstants(const std::string& name, const Function* f,
                     const std::vector<VariableAt>& arguments) const;
  bool Knows(Variable variable) const;
  /// Of any variable, for messages: its name, or what it is if it is not of this problem.
  std::string DescriptionOf(Variable variable) const;

  std::string name_;
  std::int64_t number_;
  std::deque<Phase> phases_;
  std::vector<Parameter> parameters_;
  std::vector<std::pair<VariableAt, VariableAt>> continued_;
  std::vector<LinkConstraint> links_;
  std::vector<EndCost> costs_;
};

}  // namespace possibility::collocation
