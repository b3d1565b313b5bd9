#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::collocation {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A number with its gradient and Hessian with respect to a handful of variables.
struct Hyper {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;

  /// f(a), given f', f'' at a.
  static Hyper Chain(const Hyper& a, double f, double f1, double f2) {
    return {f, f1 * a.gradient, f1 * a.hessian + f2 * a.gradient * a.gradient.transpose()};
  }
};

inline Hyper operator+(const Hyper& a, const Hyper& b) {
  return {a.value + b.value, a.gradient + b.gradient, a.hessian + b.hessian};
}
inline Hyper operator*(const Hyper& a, const Hyper& b) {
  const Eigen::MatrixXd cross = a.gradient * b.gradient.transpose();
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
          a.value * b.hessian + b.value * a.hessian + cross + cross.transpose()};
}
inline Hyper operator*(double s, const Hyper& a) {
  return {s * a.value, s * a.gradient, s * a.hessian};
}
inline Hyper operator+(const Hyper& a, double s) { return {a.value + s, a.gradient, a.hessian}; }
inline Hyper operator+(double s, const Hyper& a) { return a + s; }
inline Hyper operator-(const Hyper& a) { return -1.0 * a; }
inline Hyper operator-(const Hyper& a, const Hyper& b) { return a + (-b); }
inline Hyper operator-(const Hyper& a, double s) { return a + (-s); }
inline Hyper operator-(double s, const Hyper& a) { return s + (-a); }
inline Hyper Log(const Hyper& a) {
  return Hyper::Chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
}
inline Hyper Sqrt(const Hyper& a) {
  const double root = std::sqrt(a.value);
  return Hyper::Chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}

/// A program of a few variables whose functions are given as formulas, with dense derivatives.
class SmallProgram : public NonlinearProgram {
 public:
  using Formula = std::function<Hyper(const std::vector<Hyper>&)>;

  SmallProgram(std::vector<std::pair<double, double>> bounds, Formula objective)
      : objective_(std::move(objective)) {
    lower_.resize(static_cast<int>(bounds.size()));
    upper_ = lower_;
    for (int i = 0; i < lower_.size(); ++i) std::tie(lower_[i], upper_[i]) = bounds[i];
    for (int i = 0; i < num_variables(); ++i) {
      for (int j = 0; j <= i; ++j) hessian_.Add(i, j);
    }
  }
  SmallProgram& Add(double lower, double upper, Formula constraint) {
    const int row = num_constraints();
    constraint_lower_.conservativeResize(row + 1);
    constraint_upper_.conservativeResize(row + 1);
    constraint_lower_[row] = lower;
    constraint_upper_[row] = upper;
    constraints_.push_back(std::move(constraint));
    for (int j = 0; j < num_variables(); ++j) jacobian_.Add(row, j);
    return *this;
  }
  /// Lets a test set invalid bounds, to check the message of Solve.
  Eigen::VectorXd& mutable_lower() { return lower_; }
  SparsityPattern& mutable_jacobian_pattern() { return jacobian_; }

  int num_variables() const override { return static_cast<int>(lower_.size()); }
  int num_constraints() const override { return static_cast<int>(constraints_.size()); }
  const Eigen::VectorXd& lower() const override { return lower_; }
  const Eigen::VectorXd& upper() const override { return upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }

  double Objective(const Eigen::VectorXd& x) override { return objective_(Seed(x)).value; }
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override {
    *gradient = objective_(Seed(x)).gradient;
  }
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override {
    for (int i = 0; i < num_constraints(); ++i) (*g)[i] = constraints_[i](Seed(x)).value;
  }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_; }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override {
    const int n = num_variables();
    for (int i = 0; i < num_constraints(); ++i) {
      values->segment(i * n, n) = constraints_[i](Seed(x)).gradient;
    }
  }
  const SparsityPattern& hessian_pattern() const override { return hessian_; }
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override {
    Hyper sum = objective_factor * objective_(Seed(x));
    for (int i = 0; i < num_constraints(); ++i) {
      sum = sum + multipliers[i] * constraints_[i](Seed(x));
    }
    for (int k = 0; k < hessian_.size(); ++k) {
      (*values)[k] = sum.hessian(hessian_.rows[k], hessian_.columns[k]);
    }
  }
  std::string VariableName(int variable) const override { return fmt::format("x{}", variable + 1); }
  std::string ConstraintName(int constraint) const override {
    return fmt::format("g{}", constraint + 1);
  }

 private:
  std::vector<Hyper> Seed(const Eigen::VectorXd& x) const {
    const int n = num_variables();
    std::vector<Hyper> seeds;
    for (int i = 0; i < n; ++i) {
      seeds.push_back({x[i], Eigen::VectorXd::Unit(n, i), Eigen::MatrixXd::Zero(n, n)});
    }
    return seeds;
  }

  Formula objective_;
  std::vector<Formula> constraints_;
  Eigen::VectorXd lower_, upper_, constraint_lower_, constraint_upper_;
  SparsityPattern jacobian_, hessian_;
};

}  // namespace possibility::collocation
