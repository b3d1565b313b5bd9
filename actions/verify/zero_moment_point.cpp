#include "actions/verify/zero_moment_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOneLevel = 1e-3;  // m, as the verifier tolerates
constexpr double kSamePlace = 1e-3;   // m

bool IsLevel(const Eigen::Matrix3Xd& points) {
  return points.row(2).maxCoeff() - points.row(2).minCoeff() < kOneLevel;
}

}  // namespace

std::optional<Vector3d> ZeroMomentPoint(const Eigen::Matrix3Xd& points,
                                        const Eigen::Matrix3Xd& forces, double least_load) {
  const double load = forces.row(2).sum();
  if (!(load > least_load)) return std::nullopt;
  Vector3d zmp = points * forces.row(2).transpose() / load;
  const double height = zmp.z();
  zmp -= forces * (points.row(2).array() - height).matrix().transpose() / load;
  zmp.z() = height;
  return zmp;
}

/// Every edge of a hull has all points on one side.
double SupportMargin(const Eigen::Matrix3Xd& points, const Vector2d& p) {
  double margin = std::numeric_limits<double>::quiet_NaN();
  if (points.cols() == 0 || !IsLevel(points)) return margin;
  const Eigen::Matrix2Xd corners = points.topRows<2>();
  for (const auto& a : corners.colwise()) {
    for (const auto& b : corners.colwise()) {
      if ((b - a).norm() < kSamePlace) continue;
      const Vector2d inward = Vector2d(a.y() - b.y(), b.x() - a.x()).normalized();
      const Eigen::VectorXd depths = (corners.colwise() - a).transpose() * inward;
      if (depths.minCoeff() < -1e-9 || depths.maxCoeff() < kSamePlace) continue;
      margin = std::fmin(margin, inward.dot(p - a));
    }
  }
  return margin;
}

}  // namespace possibility::actions
