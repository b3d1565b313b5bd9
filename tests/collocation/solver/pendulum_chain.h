#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::collocation {

/// A program of any size with the structure of direct collocation. A chain of actuated pendulums,
/// coupled by springs, swings from hanging to a target in least time and effort. It has the
/// trapezoidal rule, a free duration (a dense column), bounds, and at each knot an inequality on
/// the torques.
class PendulumChain : public NonlinearProgram {
 public:
  struct Settings {
    int pendulums = 4;
    int knots = 50;
    double target = M_PI;          // upright: many local minima; 0.5: one
    double torque = 0.6;           // bound of each torque
    double torques_squared = 0.9;  // bound of the torques' sum of squares
    double spring = 0.3;
    double effort = 0.1;
  };

  explicit PendulumChain(const Settings& settings) : s_(settings) {
    const int n = 1 + s_.knots * 3 * s_.pendulums;
    const double inf = std::numeric_limits<double>::infinity();
    lower_.setConstant(n, -inf);
    upper_.setConstant(n, inf);
    lower_[0] = 1;
    upper_[0] = 100;
    for (int k = 0; k < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        Bound(Angle(k, i), -2 * M_PI, 2 * M_PI);
        Bound(Rate(k, i), -5, 5);
        Bound(Torque(k, i), -s_.torque, s_.torque);
      }
    }
    for (int i = 0; i < s_.pendulums; ++i) {
      Bound(Angle(0, i), 0, 0);
      Bound(Rate(0, i), 0, 0);
      Bound(Angle(s_.knots - 1, i), s_.target, s_.target);
      Bound(Rate(s_.knots - 1, i), 0, 0);
    }
    const int defects = (s_.knots - 1) * 2 * s_.pendulums;
    constraint_lower_ = Eigen::VectorXd::Zero(defects + s_.knots);
    constraint_upper_ = constraint_lower_;
    constraint_lower_.tail(s_.knots).setConstant(-inf);
    constraint_upper_.tail(s_.knots).setConstant(s_.torques_squared);
    const Eigen::VectorXd x = Guess();
    ForJacobian(x, [&](int row, int column, double) { jacobian_.Add(row, column); });
    ForHessian(x, 1, Eigen::VectorXd::Ones(num_constraints()),
               [&](int row, int column, double) { hessian_.Add(row, column); });
  }

  Eigen::VectorXd Guess() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(num_variables());
    x[0] = 10;
    for (int k = 0; k < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) x[Angle(k, i)] = s_.target * k / (s_.knots - 1);
    }
    return x;
  }

  int num_variables() const override { return static_cast<int>(lower_.size()); }
  int num_constraints() const override { return static_cast<int>(constraint_lower_.size()); }
  const Eigen::VectorXd& lower() const override { return lower_; }
  const Eigen::VectorXd& upper() const override { return upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }

  double Objective(const Eigen::VectorXd& x) override {
    return x[0] * (1 + s_.effort * MeanSquaredTorque(x));
  }
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) override {
    gradient->setZero();
    (*gradient)[0] = 1 + s_.effort * MeanSquaredTorque(x);
    for (int k = 0; k < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        (*gradient)[Torque(k, i)] = 2 * s_.effort * x[0] / s_.knots * x[Torque(k, i)];
      }
    }
  }
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) override {
    const double half_step = x[0] * HalfStep();
    for (int k = 0; k + 1 < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        (*g)[AngleDefect(k, i)] =
            x[Angle(k + 1, i)] - x[Angle(k, i)] - half_step * (x[Rate(k, i)] + x[Rate(k + 1, i)]);
        (*g)[RateDefect(k, i)] = x[Rate(k + 1, i)] - x[Rate(k, i)] -
                                 half_step * (Acceleration(x, k, i) + Acceleration(x, k + 1, i));
      }
    }
    for (int k = 0; k < s_.knots; ++k) {
      double sum = 0;
      for (int i = 0; i < s_.pendulums; ++i) sum += x[Torque(k, i)] * x[Torque(k, i)];
      (*g)[TorqueRow(k)] = sum;
    }
  }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_; }
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) override {
    int next = 0;
    ForJacobian(x, [&](int, int, double value) { (*values)[next++] = value; });
  }
  const SparsityPattern& hessian_pattern() const override { return hessian_; }
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) override {
    int next = 0;
    ForHessian(x, objective_factor, multipliers,
               [&](int, int, double value) { (*values)[next++] = value; });
  }
  std::string VariableName(int variable) const override {
    if (variable == 0) return "duration";
    const int knot = (variable - 1) / (3 * s_.pendulums);
    return fmt::format("knot {}: {}", knot, (variable - 1) % (3 * s_.pendulums));
  }
  std::string ConstraintName(int constraint) const override {
    return fmt::format("row {}", constraint);
  }

 private:
  int Angle(int k, int i) const { return 1 + 3 * k * s_.pendulums + i; }
  int Rate(int k, int i) const { return Angle(k, i) + s_.pendulums; }
  int Torque(int k, int i) const { return Rate(k, i) + s_.pendulums; }
  int AngleDefect(int k, int i) const { return 2 * k * s_.pendulums + i; }
  int RateDefect(int k, int i) const { return AngleDefect(k, i) + s_.pendulums; }
  int TorqueRow(int k) const { return 2 * (s_.knots - 1) * s_.pendulums + k; }
  double HalfStep() const { return 0.5 / (s_.knots - 1); }
  void Bound(int variable, double lower, double upper) {
    lower_[variable] = lower;
    upper_[variable] = upper;
  }
  double MeanSquaredTorque(const Eigen::VectorXd& x) const {
    double sum = 0;
    for (int k = 0; k < s_.knots; ++k) {
      sum += x.segment(Torque(k, 0), s_.pendulums).squaredNorm();
    }
    return sum / s_.knots;
  }
  double Acceleration(const Eigen::VectorXd& x, int k, int i) const {
    double a = x[Torque(k, i)] - std::sin(x[Angle(k, i)]);
    if (i > 0) a += s_.spring * (x[Angle(k, i - 1)] - x[Angle(k, i)]);
    if (i + 1 < s_.pendulums) a += s_.spring * (x[Angle(k, i + 1)] - x[Angle(k, i)]);
    return a;
  }
  /// Calls emit(variable, derivative) for each variable that the acceleration depends on.
  template <typename Emit>
  void ForAcceleration(const Eigen::VectorXd& x, int k, int i, const Emit& emit) const {
    emit(Torque(k, i), 1.0);
    const int neighbours = (i > 0) + (i + 1 < s_.pendulums);
    emit(Angle(k, i), -std::cos(x[Angle(k, i)]) - s_.spring * neighbours);
    if (i > 0) emit(Angle(k, i - 1), s_.spring);
    if (i + 1 < s_.pendulums) emit(Angle(k, i + 1), s_.spring);
  }
  template <typename Emit>
  void ForJacobian(const Eigen::VectorXd& x, const Emit& emit) const {
    const double half_step = x[0] * HalfStep();
    for (int k = 0; k + 1 < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        const int angle = AngleDefect(k, i), rate = RateDefect(k, i);
        emit(angle, Angle(k + 1, i), 1.0);
        emit(angle, Angle(k, i), -1.0);
        emit(angle, Rate(k, i), -half_step);
        emit(angle, Rate(k + 1, i), -half_step);
        emit(angle, 0, -HalfStep() * (x[Rate(k, i)] + x[Rate(k + 1, i)]));
        emit(rate, Rate(k + 1, i), 1.0);
        emit(rate, Rate(k, i), -1.0);
        for (const int knot : {k, k + 1}) {
          ForAcceleration(x, knot, i, [&](int variable, double derivative) {
            emit(rate, variable, -half_step * derivative);
          });
        }
        emit(rate, 0, -HalfStep() * (Acceleration(x, k, i) + Acceleration(x, k + 1, i)));
      }
    }
    for (int k = 0; k < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        emit(TorqueRow(k), Torque(k, i), 2 * x[Torque(k, i)]);
      }
    }
  }
  template <typename Emit>
  void ForHessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
                  const Emit& emit) const {
    const double half_step = x[0] * HalfStep();
    for (int k = 0; k < s_.knots; ++k) {
      for (int i = 0; i < s_.pendulums; ++i) {
        const int torque = Torque(k, i);
        const double effort = 2 * factor * s_.effort / s_.knots;
        emit(torque, torque, effort * x[0] + 2 * multipliers[TorqueRow(k)]);
        emit(torque, 0, effort * x[torque]);
        for (const int interval : {k - 1, k}) {
          if (interval < 0 || interval + 1 >= s_.knots) continue;
          const double lambda = multipliers[RateDefect(interval, i)];
          emit(Rate(k, i), 0, -HalfStep() * multipliers[AngleDefect(interval, i)]);
          ForAcceleration(x, k, i, [&](int variable, double derivative) {
            emit(variable, 0, -HalfStep() * lambda * derivative);
          });
          emit(Angle(k, i), Angle(k, i), -half_step * lambda * std::sin(x[Angle(k, i)]));
        }
      }
    }
  }

  Settings s_;
  Eigen::VectorXd lower_, upper_, constraint_lower_, constraint_upper_;
  SparsityPattern jacobian_, hessian_;
};

}  // namespace possibility::collocation
