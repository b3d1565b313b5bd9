#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/contact/contact_forces.h"
#include "dynamics/forward/forward_dynamics.h"

namespace possibility::dynamics {

/// Whether the ground can provide the impulses of an impact.
struct ImpulseFeasibility {
  bool feasible = false;  ///< friction_fraction <= 1
  /// Least fraction of the friction coefficient at which impulses in the friction cones suffice.
  /// Above 1 the contacts would slip. Infinite if no friction suffices: some point would have to
  /// pull, or there is no friction at all.
  double friction_fraction = 0;
  /// 3 x points, on the robot, world axes, N s. They have the same effect on the robot as those of
  /// the impact. They lie in the cones of friction_fraction if that is finite, and otherwise have
  /// the least pull.
  Eigen::Matrix3Xd impulses;
  /// The point that pulls hardest, if a point must pull.
  std::optional<int> pulling_point;
};

/// Searches all impulses that have the same effect on the robot as `impulses`; a rigid body cannot
/// tell them apart. `jacobian`: of the points, stacked, 3 points x nv.
/// @throws std::invalid_argument if sizes disagree, a number is not finite, a normal is not a unit
/// vector or `friction` is negative.
ImpulseFeasibility CheckImpulses(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                                 const Eigen::Ref<const Eigen::Matrix3Xd>& impulses,
                                 const std::vector<ContactPoint>& points, double friction);

/// The same for an impact of `dynamics` at its current state, as returned by ForwardDynamics::Hit.
ImpulseFeasibility CheckImpact(ForwardDynamics* dynamics, const Impact& impact,
                               const std::vector<ContactPoint>& points, double friction);

/// Least fractions of friction and motor effort that a motion needs.
struct ContactMargins {
  /// Least fraction of friction at which forces in the cones realise the motion, with torques
  /// within settings.torque_margin.
  double friction_fraction = 0;
  /// Least fraction of the effort limits, with forces within settings.friction_margin. The two
  /// fractions may need different forces.
  double effort_fraction = 0;
};

/// Margins at the state and acceleration set; none if DistributeContactForces finds no forces under
/// `settings`. Exact to kMarginPrecision for the pyramids inside the cones. Their least fraction is
/// at most 1 / cos(pi / cone_edges) times that of the cones: use 32 edges for margins accurate to
/// half a per cent. Joints without a limit and those of limit 0 need no fraction.
/// @throws std::invalid_argument as DistributeContactForces.
std::optional<ContactMargins> ComputeContactMargins(MultibodyDynamics* dynamics,
                                                    const std::vector<ContactPoint>& points,
                                                    const ContactForceSettings& settings);

/// Precision of these fractions.
inline constexpr double kMarginPrecision = 1e-6;

}  // namespace possibility::dynamics
