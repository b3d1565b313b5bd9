#include "actions/wholebody/force_fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "actions/wholebody/required_zero_moment_point.h"
#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using dynamics::ContactForces;
using dynamics::ContactForceSettings;
using dynamics::ContactPoint;
using dynamics::MultibodyDynamics;
using Eigen::Vector2d;

/// Margins so wide that they do not bind.
constexpr double kUnlimited = 1e3;
/// Of a limit found: the share is exact to this factor.
constexpr double kPrecision = 1.01;
/// Bearing points are level if their heights differ by less, m.
constexpr double kLevel = 1e-3;

/// The least value of a margin in [infeasible, feasible] with which forces exist. Returns those
/// forces.
ContactForces AtLeastMargin(MultibodyDynamics* dynamics, const std::vector<ContactPoint>& points,
                            const ContactForceSettings& settings,
                            double ContactForceSettings::*margin, double infeasible,
                            double feasible, ContactForces forces) {
  ContactForceSettings tried = settings;
  while (feasible > kPrecision * infeasible) {
    tried.*margin = std::sqrt(infeasible * feasible);
    const auto found = DistributeContactForces(dynamics, points, tried);
    (found ? feasible : infeasible) = tried.*margin;
    if (found) forces = *found;
  }
  return forces;
}

std::string TorqueFault(const MultibodyDynamics& dynamics, const ContactForceSettings& settings,
                        const ContactForces& forces) {
  const dynamics::MultibodyModel& model = dynamics.model();
  Eigen::Index worst = 0;
  const Eigen::VectorXd& limits = dynamics.torque_limits();
  forces.torques.cwiseAbs().cwiseQuotient(limits.cwiseMax(1e-9)).maxCoeff(&worst);
  return fmt::format("{} needs {:.1f} of {:.1f}", model.tree().joints[model.joints()[worst]].name,
                     std::abs(forces.torques[worst]), settings.torque_margin * limits[worst]);
}

/// Of the most slippery ground.
double LeastFriction(const std::vector<ContactPoint>& points, double robots) {
  double least = robots;
  for (const ContactPoint& point : points) least = std::min(least, point.friction);
  return least;
}

std::string BalanceFault(MultibodyDynamics* dynamics, const std::vector<ContactPoint>& points) {
  if (points.empty()) return "the motion needs a contact";
  if (dynamics->InverseDynamics()[5] <= 0) return "the ground would have to pull";
  std::vector<Vector2d> support;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const ContactPoint& point : points) {
    const Eigen::Vector3d p = dynamics->kinematics().Position(point.link, point.p_L);
    support.push_back(p.head<2>());
    lowest = std::min(lowest, p.z());
    highest = std::max(highest, p.z());
  }
  const Vector2d zmp = RequiredZeroMomentPoint(dynamics, lowest);
  const double outside = -SupportPolygon(support).Margin(zmp);
  if (highest - lowest > kLevel || !(outside > 0)) {
    return "no contact forces within friction cones realise the motion";
  }
  return fmt::format("the centre of pressure is {:.0f} mm outside the support", 1000 * outside);
}

}  // namespace

MotionError ForceFault(MultibodyDynamics* dynamics, const std::vector<ContactPoint>& points,
                       const ContactForceSettings& settings) {
  ContactForceSettings tried = settings;
  tried.torque_margin = kUnlimited;
  if (const auto forces = DistributeContactForces(dynamics, points, tried)) {
    const ContactForces least =
        AtLeastMargin(dynamics, points, settings, &ContactForceSettings::torque_margin,
                      settings.torque_margin, forces->torque_utilisation, *forces);
    return MotionError(TorqueFault(*dynamics, settings, least), -1, MotionError::Limit::kTorque);
  }
  tried.friction_margin = kUnlimited;
  if (const auto forces = DistributeContactForces(dynamics, points, tried)) {
    tried.friction_margin = settings.friction_margin;
    const ContactForces least = AtLeastMargin(
        dynamics, points, tried, &ContactForceSettings::friction_margin, settings.friction_margin,
        std::max(forces->friction_utilisation, settings.friction_margin), *forces);
    const double friction = LeastFriction(points, settings.friction);
    return MotionError(
        fmt::format("the contacts need a friction of {:.2f} of {:.2f}",
                    least.friction_utilisation * friction, settings.friction_margin * friction),
        -1, MotionError::Limit::kFriction);
  }
  return MotionError(BalanceFault(dynamics, points));
}

}  // namespace possibility::actions
