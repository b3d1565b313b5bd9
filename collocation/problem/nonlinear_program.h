#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace possibility::collocation {

/// The places of a sparse matrix's entries; one value per entry, duplicates add up.
struct SparsityPattern {
  std::vector<int> rows;
  std::vector<int> columns;

  int size() const { return static_cast<int>(rows.size()); }
  void Add(int row, int column) {
    rows.push_back(row);
    columns.push_back(column);
  }
};

/// Minimise f(x) subject to lower <= x <= upper and constraint_lower <= g(x) <= constraint_upper,
/// with possibly infinite bounds and exact sparse derivatives. A function that cannot be evaluated
/// (NaN, a workspace that throws) throws std::runtime_error or returns values that are not finite.
/// The solver then shortens its step, or gives up if this happens at the starting point.
class NonlinearProgram {
 public:
  virtual ~NonlinearProgram() = default;

  virtual int num_variables() const = 0;
  virtual int num_constraints() const = 0;
  virtual const Eigen::VectorXd& lower() const = 0;
  virtual const Eigen::VectorXd& upper() const = 0;
  virtual const Eigen::VectorXd& constraint_lower() const = 0;
  virtual const Eigen::VectorXd& constraint_upper() const = 0;

  virtual double Objective(const Eigen::VectorXd& x) = 0;
  /// Dense: num_variables.
  virtual void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) = 0;
  virtual void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) = 0;

  /// num_constraints x num_variables.
  virtual const SparsityPattern& jacobian_pattern() const = 0;
  virtual void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) = 0;
  /// The lower triangle of the Hessian of objective_factor f + multipliers' g.
  virtual const SparsityPattern& hessian_pattern() const = 0;
  virtual void Hessian(const Eigen::VectorXd& x, double objective_factor,
                       const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) = 0;

  /// For messages: "swing, knot 3: knee_rate".
  virtual std::string VariableName(int variable) const = 0;
  virtual std::string ConstraintName(int constraint) const = 0;
  /// Places along time of variables and constraints, in any unit; NaN: of no instant. A hint for
  /// the linear algebra: couplings of neighbouring instants only are quick to factorise. Empty: the
  /// program has no time.
  virtual std::vector<double> VariableTimes() const { return {}; }
  virtual std::vector<double> ConstraintTimes() const { return {}; }
  /// Divisors of variables and constraints, so that messages can report their own units.
  virtual double VariableScale(int) const { return 1; }
  virtual double ConstraintScale(int) const { return 1; }
};

}  // namespace possibility::collocation
