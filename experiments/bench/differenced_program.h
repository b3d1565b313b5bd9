#pragma once

#include <vector>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::experiments {

/// A program whose Jacobian comes from forward differences, as efficiently as differences allow:
/// constant entries are known, and columns without varying entries in a common row are stepped
/// together (Curtis, Powell and Reid 1974, "On the estimation of sparse Jacobian matrices"). A
/// Jacobian costs one evaluation of the constraints per group of columns. The gradient of the
/// objective stays exact.
class DifferencedProgram : public collocation::NonlinearProgram {
 public:
  /// `program` must outlive this object and must not have duplicate Jacobian entries. Constant
  /// entries are detected at points around `x`.
  DifferencedProgram(NonlinearProgram* program, const Eigen::VectorXd& x);

  /// Evaluations of the constraints per Jacobian, besides the one at x.
  int num_groups() const { return static_cast<int>(groups_.size()); }

  int num_variables() const override { return program_->num_variables(); }
  int num_constraints() const override { return program_->num_constraints(); }
  const Eigen::VectorXd& lower() const override { return program_->lower(); }
  const Eigen::VectorXd& upper() const override { return program_->upper(); }
  const Eigen::VectorXd& constraint_lower() const override { return program_->constraint_lower(); }
  const Eigen::VectorXd& constraint_upper() const override { return program_->constraint_upper(); }
  double Objective(const Eigen::VectorXd& x) override { return program_->Objective(x); }
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override {
    program_->Gradient(x, gradient);
  }
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override {
    program_->Constraints(x, g);
  }
  const collocation::SparsityPattern& jacobian_pattern() const override {
    return program_->jacobian_pattern();
  }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override;
  const collocation::SparsityPattern& hessian_pattern() const override {
    return program_->hessian_pattern();
  }
  /// The exact Hessian; unused with HessianMode::kLimitedMemory.
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override {
    program_->Hessian(x, objective_factor, multipliers, values);
  }
  std::string VariableName(int variable) const override { return program_->VariableName(variable); }
  std::string ConstraintName(int constraint) const override {
    return program_->ConstraintName(constraint);
  }

 private:
  void FindConstants(const Eigen::VectorXd& x);
  void GroupColumns();

  NonlinearProgram* program_;
  Eigen::VectorXd constants_;              // the Jacobian's values where constant
  std::vector<bool> is_constant_;          // by entry
  std::vector<std::vector<int>> columns_;  // entries by column
  std::vector<std::vector<int>> groups_;   // columns with varying entries
  Eigen::VectorXd at_x_, stepped_, x_stepped_;
};

}  // namespace possibility::experiments
