#include "actions/conditions/reachable_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Between angles of a joint at which directions are looked at, rad. The bound is then at most
/// 1e-3 of the reach too large for each joint.
constexpr double kAngleStep = 5 * std::numbers::pi / 180;

/// Ground this close counts as met, m: the error of clearances, and rounding.
constexpr double kRounding = 1e-5;

/// Multiples of a plane's normal that are added to a direction in it, for SupportWithin.
constexpr double kMostShear = 3;
constexpr double kShearStep = 0.25;

/// The support of a set that turns about `axis` by any angle of a range, at d. Between two angles
/// the turned direction is a combination of both, of the axis' part of it, and of weights whose sum
/// is at most 1 / cos(step / 2).
double SupportTurning(const SupportBound& set, const Vector3d& axis, double lower, double upper,
                      const Vector3d& d) {
  const double range = std::min(upper - lower, 2 * std::numbers::pi);
  const int steps = std::max(1, static_cast<int>(std::ceil(range / kAngleStep)));
  const double start = std::isfinite(lower) ? lower : -std::numbers::pi;
  const Vector3d along = axis * axis.dot(d);
  const Vector3d across = d - along;
  const Vector3d turned = axis.cross(across);
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const double angle = -(start + range * i / steps);
    most = std::max(most, set(along + std::cos(angle) * across + std::sin(angle) * turned));
  }
  const double excess = 1 / std::cos(range / steps / 2) - 1;
  return most + excess * std::max(0.0, most + set(-along));
}

double SupportSliding(const SupportBound& set, const models::Joint& joint, const Vector3d& d) {
  const double along = joint.axis.dot(d);
  return set(d) + std::max(along * joint.lower, along * joint.upper);
}

/// Of the set of a joint's child frame, in the frame of its parent link.
SupportBound ThroughJoint(const models::Joint& joint, const SupportBound& set) {
  return SupportBound([&](const Vector3d& d) {
    const Vector3d in_joint = joint.X_PJ.linear().transpose() * d;
    const double moved = joint.type == models::JointType::kPrismatic
                             ? SupportSliding(set, joint, in_joint)
                             : SupportTurning(set, joint.axis, joint.lower, joint.upper, in_joint);
    return joint.X_PJ.translation().dot(d) + moved;
  });
}

SupportBound FromRoot(const models::RobotModel& robot, const models::ContactPatch& patch) {
  SupportBound set([&](const Vector3d& d) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vector3d& p : patch.points) most = std::max(most, d.dot(p));
    return most;
  });
  for (int link = patch.link; link > 0; link = robot.joints[link - 1].parent) {
    set = ThroughJoint(robot.joints[link - 1], set);
  }
  return set;
}

/// Two unit vectors that make a frame with a unit vector.
std::pair<Vector3d, Vector3d> Across(const Vector3d& normal) {
  const Vector3d reference = std::abs(normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d first = normal.cross(reference).normalized();
  return {first, normal.cross(first)};
}

}  // namespace

ReachableRegion::ReachableRegion(const models::RobotModel& robot, const models::ContactPatch& patch)
    : support_(FromRoot(robot, patch)) {
  Vector3d half;
  for (int axis = 0; axis < 3; ++axis) {
    const double high = support_(Vector3d::Unit(axis));
    const double low = -support_(-Vector3d::Unit(axis));
    centre_R_[axis] = (low + high) / 2;
    half[axis] = (high - low) / 2;
  }
  radius_ = half.norm();
}

/// For points of the plane, e'p = (e + s normal)'p - s offset with any s.
double ReachableRegion::SupportWithin(const Vector3d& normal, double offset,
                                      const Vector3d& e) const {
  double least = std::numeric_limits<double>::infinity();
  for (double s = -kMostShear; s <= kMostShear; s += kShearStep) {
    least = std::min(least, support_(e + s * normal) - s * offset);
  }
  return least;
}

bool ReachableRegion::MeetsPlane(const models::GroundMap& ground, int plane,
                                 const Isometry3d& X_WR) const {
  const models::GroundPlane& level = ground.planes()[plane];
  const Vector3d normal = X_WR.linear().transpose() * level.normal;
  const double offset = level.offset - level.normal.dot(X_WR.translation());
  if (offset > support_(normal) + kRounding || -offset > support_(-normal) + kRounding) {
    return false;
  }
  const auto [first, second] = Across(normal);
  Vector3d centre = offset * normal;
  double square = 0;
  for (const Vector3d& e : {first, second}) {
    const double high = SupportWithin(normal, offset, e);
    const double low = -SupportWithin(normal, offset, -e);
    if (low > high + kRounding) return false;
    centre += (low + high) / 2 * e;
    square += std::pow(std::max(0.0, high - low) / 2, 2);
  }
  return ground.IsNear(plane, (X_WR * centre).head<2>(), std::sqrt(square) + kRounding);
}

bool ReachableRegion::MeetsGround(const models::GroundMap& ground, const Isometry3d& X_WR) const {
  const std::vector<int> planes = ground.PlanesNear(X_WR * centre_R_, radius_ + kRounding);
  return std::any_of(planes.begin(), planes.end(),
                     [&](int plane) { return MeetsPlane(ground, plane, X_WR); });
}

}  // namespace possibility::actions
