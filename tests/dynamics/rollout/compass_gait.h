#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <memory>

#include "dynamics/rollout/hybrid_rollout.h"

namespace possibility::dynamics {

/// The compass gait (Goswami, Thuilot & Espiau 1998): two straight legs of point masses and a point
/// mass at the hip, walking down a slope. State: lean of the stance leg, lean of the swing leg,
/// their rates. Leans are measured from the vertical, foot to hip, positive forward (towards +x,
/// downhill). The equations are derived here with Lagrange's method, in other coordinates than
/// MultibodyModel's.
struct CompassGait {
  double leg_mass = 5;
  double hip_mass = 10;
  double foot_to_mass = 0.5;
  double mass_to_hip = 0.5;
  double gravity = 9.81;
  double slope = 3 * M_PI / 180;

  double leg() const { return foot_to_mass + mass_to_hip; }

  void Rate(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> rate) const {
    const double m = leg_mass, b = mass_to_hip, l = leg(), d = x[0] - x[1];
    const double moment = m * foot_to_mass + hip_mass * l + m * l;
    Eigen::Matrix2d M;
    M << m * foot_to_mass * foot_to_mass + (hip_mass + m) * l * l, -m * l * b * std::cos(d),
        -m * l * b * std::cos(d), m * b * b;
    const Eigen::Vector2d force(
        m * l * b * std::sin(d) * x[3] * x[3] + gravity * moment * std::sin(x[0]),
        -m * l * b * std::sin(d) * x[2] * x[2] - gravity * m * b * std::sin(x[1]));
    rate.head<2>() = x.tail<2>();
    rate.tail<2>() = M.ldlt().solve(force);
  }

  double Energy(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    const double m = leg_mass, a = foot_to_mass, b = mass_to_hip, l = leg();
    return 0.5 * (m * a * a + (hip_mass + m) * l * l) * x[2] * x[2] +
           0.5 * m * b * b * x[3] * x[3] - m * l * b * std::cos(x[0] - x[1]) * x[2] * x[3] +
           gravity * ((m * a + hip_mass * l + m * l) * std::cos(x[0]) - m * b * std::cos(x[1]));
  }

  /// Masses of stance leg, hip and swing leg: their places (columns) and the derivatives with
  /// respect to the two leans. The stance foot is at the origin.
  struct Masses {
    Eigen::Matrix<double, 2, 3> place, by_stance, by_swing;
  };
  Masses MassesAt(double stance, double swing) const {
    const Eigen::Vector2d up(std::sin(stance), std::cos(stance)), turn(up.y(), -up.x());
    const Eigen::Vector2d swing_up(std::sin(swing), std::cos(swing));
    const Eigen::Vector2d swing_turn(swing_up.y(), -swing_up.x());
    Masses masses;
    masses.place << foot_to_mass * up, leg() * up, leg() * up - mass_to_hip * swing_up;
    masses.by_stance << foot_to_mass * turn, leg() * turn, leg() * turn;
    masses.by_swing.setZero();
    masses.by_swing.col(2) = -mass_to_hip * swing_turn;
    return masses;
  }

  /// The swing foot becomes the stance foot. Kept are the moment of momentum about it, and that of
  /// the old stance leg about the hip.
  Eigen::VectorXd Touchdown(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    const auto cross = [](const Eigen::Vector2d& r, const Eigen::Vector2d& p) {
      return r.x() * p.y() - r.y() * p.x();
    };
    const Masses before = MassesAt(x[0], x[1]), after = MassesAt(x[1], x[0]);
    const Eigen::Vector2d hip = before.place.col(1);
    const Eigen::Vector2d foot = hip - leg() * Eigen::Vector2d(std::sin(x[1]), std::cos(x[1]));
    const double mass[3] = {leg_mass, hip_mass, leg_mass};
    Eigen::Vector2d momentum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d inertia = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d v = before.by_stance.col(i) * x[2] + before.by_swing.col(i) * x[3];
      momentum[0] += mass[i] * cross(before.place.col(i) - foot, v);
      if (i == 0) momentum[1] = mass[i] * cross(before.place.col(i) - hip, v);
      const Eigen::Vector2d r = after.place.col(i);
      inertia.row(0) += mass[i] * Eigen::RowVector2d(cross(r, after.by_stance.col(i)),
                                                     cross(r, after.by_swing.col(i)));
    }
    const Eigen::Vector2d r = after.place.col(2) - after.place.col(1);
    inertia.row(1) = mass[2] * Eigen::RowVector2d(cross(r, after.by_stance.col(2)),
                                                  cross(r, after.by_swing.col(2)));
    Eigen::VectorXd result(4);
    result << x[1], x[0], inertia.partialPivLu().solve(momentum);
    return result;
  }

  /// The height of the swing foot is ignored while it swings through. A step ends when both feet
  /// are on the slope again with the swing foot in front.
  std::shared_ptr<const HybridMode> Mode() const {
    auto mode = std::make_shared<HybridMode>();
    const CompassGait gait = *this;
    mode->name = "single support";
    mode->rate = [gait](double, const auto& x, auto rate) { gait.Rate(x, rate); };
    mode->guards = {{GuardDirection::kRising, false}};
    mode->guard_names = {"touchdown"};
    mode->guard_values = [gait](double, const auto& x, auto values) {
      values[0] = x[0] + x[1] - 2 * gait.slope;
    };
    std::weak_ptr<const HybridMode> self = mode;
    mode->reset = [gait, self](const HybridEvent& event) {
      return HybridTransition{self.lock(), gait.Touchdown(event.before), ""};
    };
    return mode;
  }

  /// On the limit cycle just after touchdown, in degrees and rad/s: a first guess for it.
  static Eigen::Vector4d NearLimitCycle() {
    Eigen::Vector4d x;
    x << -12.6 * M_PI / 180, 18.6 * M_PI / 180, 1.1, 0.4;
    return x;
  }
};

}  // namespace possibility::dynamics
