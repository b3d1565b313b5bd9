#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::collocation {

/// A program whose rows may give way: minimise sum(above + below) subject to the bounds of x and
/// constraint_lower <= g(x) + above - below <= constraint_upper, above and below at least 0.
/// Variables: x, above, below. Always feasible.
class ElasticProgram : public NonlinearProgram {
 public:
  /// `program` must outlive this.
  explicit ElasticProgram(NonlinearProgram* program);

  /// x within its bounds, with what it violates.
  Eigen::VectorXd StartAt(const Eigen::VectorXd& x);
  auto InnerPart(const Eigen::VectorXd& x) const { return x.head(num_inner_); }

  int num_variables() const override { return static_cast<int>(lower_.size()); }
  int num_constraints() const override { return num_rows_; }
  const Eigen::VectorXd& lower() const override { return lower_; }
  const Eigen::VectorXd& upper() const override { return upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return program_->constraint_lower(); }
  const Eigen::VectorXd& constraint_upper() const override { return program_->constraint_upper(); }
  double Objective(const Eigen::VectorXd& x) override { return x.tail(2 * num_rows_).sum(); }
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override;
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override;
  const SparsityPattern& jacobian_pattern() const override { return jacobian_pattern_; }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override;
  const SparsityPattern& hessian_pattern() const override { return program_->hessian_pattern(); }
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override;
  std::string VariableName(int variable) const override;
  std::string ConstraintName(int constraint) const override {
    return program_->ConstraintName(constraint);
  }
  std::vector<double> VariableTimes() const override;
  std::vector<double> ConstraintTimes() const override { return program_->ConstraintTimes(); }

 private:
  NonlinearProgram* program_;
  int num_inner_, num_rows_;
  Eigen::VectorXd lower_, upper_;
  SparsityPattern jacobian_pattern_;
  Eigen::VectorXd inner_values_;
};

}  // namespace possibility::collocation
