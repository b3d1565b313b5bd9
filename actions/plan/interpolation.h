#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "actions/plan/plan.h"

namespace possibility::actions {

/// The motion between two knots of a phase as Interpolate defines it, coefficients computed once.
/// The knots must outlive it and agree in their sizes.
class KnotInterpolant {
 public:
  /// @throws std::invalid_argument if sizes disagree or k1.t <= k0.t.
  KnotInterpolant(const Knot& k0, const Knot& k1);

  using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 6>;

  /// `t` is clamped to [k0.t, k1.t]; at both ends the knots themselves are returned.
  Knot At(double t) const;
  /// Of the same: positions and velocities of the joints (n) and their torques, at a fraction of
  /// the time.
  void JointsAt(double t, Eigen::VectorXd* position, Eigen::VectorXd* velocity,
                Eigen::VectorXd* torque) const;
  /// q of the same.
  Eigen::VectorXd ConfigurationAt(double t) const;

  double start() const { return k0_->t; }  ///< s
  double duration() const { return h_; }   ///< s

  /// Bernstein coefficients over [k0.t, k1.t] of the interpolant: rotation vector (3 rows), root
  /// position (3), joints. Every value lies within the range of its row's coefficients.
  Coefficients ControlPoints() const;

 private:
  Eigen::VectorXd Configuration(const Eigen::VectorXd& x) const;

  const Knot* k0_;
  const Knot* k1_;
  double h_;
  Eigen::Quaterniond R0_;
  /// Powers of s = (t - k0.t) / h of: rotation vector (3 rows), root position (3), joints.
  Coefficients c_;
};

}  // namespace possibility::actions
