#pragma once

#include <Eigen/Core>

namespace possibility::actions {

/// The wrench (torque about the root's origin, N m; force, N) of forces at points. `arms`: 3 x
/// points, m, from the root's origin; `forces`: 3 x points, N; world axes.
Eigen::Matrix<double, 6, 1> WrenchOf(const Eigen::Matrix3Xd& arms, const Eigen::Matrix3Xd& forces);

/// Contact forces between knots are interpolated ones and this change: the least, each in
/// proportion to the point's load, that supplies what the root is missing, as far as the points can
/// (docs/file_formats.md, "Meaning between knots"). `arms` and `forces` as above; `weight`: N;
/// `missing`: a wrench, see WrenchOf. There must be a point.
Eigen::Matrix3Xd LeastForceChange(const Eigen::Matrix3Xd& arms, const Eigen::Matrix3Xd& forces,
                                  double weight, const Eigen::Matrix<double, 6, 1>& missing);

}  // namespace possibility::actions
