#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/plan/interpolation.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Bounds on the magnitude of a function of time and of its first four derivatives over an
/// interval: entry k bounds the k-th derivative.
using Derivatives = std::array<double, 5>;

/// Bounds how fast all quantities may change between two knots, and thus their values between
/// samples: a function known at both ends of a time h deviates from the straight line between by at
/// most h^2 / 8 times its second derivative. Computed from the Bernstein coefficients of the knots'
/// polynomials by the triangle inequality along the tree: valid for every robot, but not tight. One
/// per thread.
class DerivativeBounds {
 public:
  /// `robot` must outlive it.
  explicit DerivativeBounds(const models::RobotModel& robot);

  /// Computes the bounds for all times between the knots of `interpolant`, with `points` bearing.
  void Set(const KnotInterpolant& interpolant, const Knot& k0, const Knot& k1,
           const std::vector<BearingPoint>& points);

  /// Bounds for the position of a link's origin; entry 0 is meaningless.
  const Derivatives& Origin(int link) const { return links_[link].origin; }
  /// Bounds for the rotation of a link (operator norms); entry k + 1 bounds the k-th derivative of
  /// its angular velocity.
  const Derivatives& Rotation(int link) const { return links_[link].rotation; }
  /// Bound of the k-th derivative of the position of any point of a link within `radius` of its
  /// origin; k > 0.
  double Point(int link, double radius, int k) const {
    return links_[link].origin[k] + radius * links_[link].rotation[k];
  }

  /// Second time derivatives of the wrench that the motion needs from the ground beyond the
  /// declared forces (which are linear in time): force (N/s^2) and torque about the root's origin
  /// (N m/s^2).
  double force_change() const { return force_change_; }
  double moment_change() const { return moment_change_; }
  /// The same for the torque of a joint against its limit, N m/s^2 or N/s^2.
  double JointTorqueChange(int joint) const { return torque_change_[joint]; }
  /// Second and third derivative of the position of a bearing point: maximum over the points.
  double point_acceleration() const { return point_acceleration_; }  ///< m/s^2
  double point_jerk() const { return point_jerk_; }                  ///< m/s^3

 private:
  struct LinkBounds {
    Derivatives turning{};   ///< 1..4: of the rotation vector, summed from the root on
    Derivatives rotation{};  ///< 0..4
    Derivatives joint{};     ///< 0..4: of the position of the joint that moves the link
    Derivatives arm{};       ///< 0..4: from the parent's origin
    Derivatives origin{};    ///< 1..4
    // Value and first two derivatives of the wrench that moves the link and all links beyond it.
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
