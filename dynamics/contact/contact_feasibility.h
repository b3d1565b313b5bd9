#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/contact/contact_forces.h"
#include "dynamics/forward/forward_dynamics.h"

namespace possibility::dynamics {

/// Whether the ground can give the impulses of an impact.
struct ImpulseFeasibility {
  bool feasible = false;  ///< friction_fraction <= 1
  /// The least fraction of the friction coefficient at which impulses in the cones do it; above 1
  /// the contacts would slip; infinite if no friction is enough: some point would have to pull, or
  /// there is no friction at all.
  double friction_fraction = 0;
  /// 3 x points, on the robot, world axes, N s: they act on the robot exactly as those of the
  /// impact do, in the cones of friction_fraction if that is finite, and else with the least pull.
  Eigen::Matrix3Xd impulses;
  /// The point that pulls hardest, where some point must.
  std::optional<int> pulling_point;
};

/// Impulses that differ but act alike on the robot are alike to a rigid body: searches among all
/// of them. `jacobian`: of the points, stacked, 3 points x nv.
/// @throws std::invalid_argument if sizes disagree, a number is not finite, a normal is no unit
/// vector or `friction` is negative.
ImpulseFeasibility CheckImpulses(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                                 const Eigen::Ref<const Eigen::Matrix3Xd>& impulses,
                                 const std::vector<ContactPoint>& points, double friction);

/// The same for an impact of `dynamics` at the state set, as ForwardDynamics::Hit returned it.
ImpulseFeasibility CheckImpact(ForwardDynamics* dynamics, const Impact& impact,
                               const std::vector<ContactPoint>& points, double friction);

/// How much of friction and motors a motion needs at the least.
struct ContactMargins {
  /// Least fraction of friction with which forces in the cones realise the motion, torques within
  /// settings.torque_margin.
  double friction_fraction = 0;
  /// Least fraction of the effort limits, forces within settings.friction_margin; each of the two
  /// may need forces of its own.
  double effort_fraction = 0;
};

/// At the state and acceleration set; none if DistributeContactForces finds no forces under
/// `settings`. Exact to kMarginPrecision above the least fraction of the pyramids inside the
/// cones, which is 1 / cos(pi / cone_edges) of the cones' own at most: use 32 edges for margins
/// true to half a per cent. Joints without a limit and those of limit 0 need no fraction.
/// @throws std::invalid_argument as DistributeContactForces.
std::optional<ContactMargins> ComputeContactMargins(MultibodyDynamics* dynamics,
                                                    const std::vector<ContactPoint>& points,
                                                    const ContactForceSettings& settings);

/// Of the fractions above.
inline constexpr double kMarginPrecision = 1e-6;

}  // namespace possibility::dynamics
