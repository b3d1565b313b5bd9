#pragma once

#include <Eigen/Core>
#include <optional>

namespace possibility::actions {

/// Zero moment point of contact forces (Vukobratovic and Borovac 2004): the place, on the level
/// plane through the load's mean height, about which the forces have no horizontal moment. If all
/// points are equally high, it is the centre of pressure. m.
///
/// `points`: where the forces act, 3 x n, m. `forces`: on the robot, 3 x n, N; both in the world.
/// None unless the forces' vertical sum exceeds `least_load` (>= 0, N).
std::optional<Eigen::Vector3d> ZeroMomentPoint(const Eigen::Matrix3Xd& points,
                                               const Eigen::Matrix3Xd& forces, double least_load);

/// Signed distance from p to the edge of the support polygon, the convex hull of the bearing points
/// seen from above; inside positive, m. Not a number if the points differ in height by 1 mm or
/// more, or have no area.
double SupportMargin(const Eigen::Matrix3Xd& points, const Eigen::Vector2d& p);

}  // namespace possibility::actions
