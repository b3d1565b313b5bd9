#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "actions/plan/interpolation.h"
#include "actions/verify/verifier_state.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Bounds on the magnitude of a function of time and of its first four derivatives, over an
/// interval: entry k is of the k-th.
using Derivatives = std::array<double, 5>;

/// How fast everything may change between two knots, so that what samples do not show is bounded:
/// a function that is known at both ends of a time h is within h^2 / 8 times its second derivative
/// of the straight line between. From the Bernstein coefficients of the knots' polynomials, by the
/// triangle inequality along the tree: true of every robot, and tight for none. One per thread.
class DerivativeBounds {
 public:
  /// `robot` must outlive it.
  explicit DerivativeBounds(const models::RobotModel& robot);

  /// Bounds for all times between the knots of `interpolant`, which bear with `points`.
  void Set(const KnotInterpolant& interpolant, const Knot& k0, const Knot& k1,
           const std::vector<BearingPoint>& points);

  /// Of the position of a link's origin; entry 0 means nothing.
  const Derivatives& Origin(int link) const { return links_[link].origin; }
  /// Of the rotation of a link (operator norms); entry k + 1 bounds the k-th derivative of its
  /// angular velocity.
  const Derivatives& Rotation(int link) const { return links_[link].rotation; }
  /// k-th derivative of the position of any point of a link within `radius` of its origin; k > 0.
  double Point(int link, double radius, int k) const {
    return links_[link].origin[k] + radius * links_[link].rotation[k];
  }

  /// Second derivatives in time of what the motion takes from the ground beyond the declared
  /// forces, linear in time: force (N/s^2) and torque about the root's origin (N m/s^2).
  double force_change() const { return force_change_; }
  double moment_change() const { return moment_change_; }
  /// Likewise of the torque of a joint, N m/s^2 or N/s^2.
  double JointTorqueChange(int joint) const { return torque_change_[joint]; }
  /// Second and third derivative of the position of the bearing point that has most of it.
  double point_acceleration() const { return point_acceleration_; }  ///< m/s^2
  double point_jerk() const { return point_jerk_; }                  ///< m/s^3

 private:
  struct LinkBounds {
    Derivatives turning{};   ///< 1..4: of the rotation vector, summed from the root on
    Derivatives rotation{};  ///< 0..4
    Derivatives joint{};     ///< 0..4: of the position of the joint that moves the link
    Derivatives arm{};       ///< 0..4: from the parent's origin
    Derivatives origin{};    ///< 1..4
    // Value and first two derivatives of what moves the link and all beyond it.
    std::array<double, 3> force{};
    std::array<double, 3> moment{};  ///< about the link's origin
  };

  void SetCoordinates(const KnotInterpolant& interpolant);
  void SetLinks();
  void SetForces();
  void AddContacts(const Knot& k0, const Knot& k1, const std::vector<BearingPoint>& points);

  const models::RobotModel* robot_;
  std::vector<double> spins_;  ///< by link: largest principal moment of inertia, kg m^2
  std::vector<LinkBounds> links_;
  double force_change_ = 0;
  double moment_change_ = 0;
  double point_acceleration_ = 0;
  double point_jerk_ = 0;
  std::vector<double> torque_change_;
};

}  // namespace possibility::actions
