#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <random>
#include <string>

#include "collocation/problem/nonlinear_program.h"
#include "tests/collocation/solver/small_program.h"

namespace possibility::collocation {

/// min 1/2 x'H x + c'x subject to bounds and to rows A x, with dense matrices.
class QuadraticProgram : public NonlinearProgram {
 public:
  QuadraticProgram(const Eigen::MatrixXd& h, const Eigen::VectorXd& c, const Eigen::MatrixXd& a)
      : h_(h), c_(c), a_(a) {
    const auto n = h.rows(), m = a.rows();
    lower_.setConstant(n, -kUnbounded);
    upper_.setConstant(n, kUnbounded);
    row_lower_.setConstant(m, -kUnbounded);
    row_upper_.setConstant(m, kUnbounded);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) hessian_.Add(i, j);
    }
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < n; ++j) jacobian_.Add(i, j);
    }
  }
  Eigen::VectorXd& mutable_lower() { return lower_; }
  Eigen::VectorXd& mutable_upper() { return upper_; }
  Eigen::VectorXd& mutable_row_lower() { return row_lower_; }
  Eigen::VectorXd& mutable_row_upper() { return row_upper_; }

  int num_variables() const override { return static_cast<int>(h_.rows()); }
  int num_constraints() const override { return static_cast<int>(a_.rows()); }
  const Eigen::VectorXd& lower() const override { return lower_; }
  const Eigen::VectorXd& upper() const override { return upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return row_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return row_upper_; }
  double Objective(const Eigen::VectorXd& x) override { return 0.5 * x.dot(h_ * x) + c_.dot(x); }
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override {
    *gradient = h_ * x + c_;
  }
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override { *g = a_ * x; }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_; }
  void Jacobian(const Eigen::VectorXd&, Eigen::VectorXd* values) override {
    for (int k = 0; k < jacobian_.size(); ++k) {
      (*values)[k] = a_(jacobian_.rows[k], jacobian_.columns[k]);
    }
  }
  const SparsityPattern& hessian_pattern() const override { return hessian_; }
  void Hessian(const Eigen::VectorXd&, double objective_factor, const Eigen::VectorXd&,
               Eigen::VectorXd* values) override {
    for (int k = 0; k < hessian_.size(); ++k) {
      (*values)[k] = objective_factor * h_(hessian_.rows[k], hessian_.columns[k]);
    }
  }
  std::string VariableName(int variable) const override { return fmt::format("x{}", variable); }
  std::string ConstraintName(int constraint) const override {
    return fmt::format("row{}", constraint);
  }

 private:
  Eigen::MatrixXd h_;
  Eigen::VectorXd c_;
  Eigen::MatrixXd a_;
  Eigen::VectorXd lower_, upper_, row_lower_, row_upper_;
  SparsityPattern jacobian_, hessian_;
};

inline Eigen::MatrixXd NormalMatrix(int rows, int columns, std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(*random); });
}

}  // namespace possibility::collocation
