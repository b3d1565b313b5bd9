#include "dynamics/forward/rigid_points.h"

#include <Eigen/QR>
#include <algorithm>

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Lengths below this fraction of the group's size count as rounding.
constexpr double kRank = 1e-9;

Eigen::Matrix3d Cross(const Vector3d& r) {
  Eigen::Matrix3d matrix;
  matrix << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return matrix;
}

/// Translations, and rotations about the centre of the points.
MatrixXd BasisOf(const std::vector<ContactPoint>& points, const std::vector<std::size_t>& group) {
  Vector3d centre = Vector3d::Zero();
  for (const std::size_t i : group) centre += points[i].p_L / static_cast<double>(group.size());
  double size = 0;
  for (const std::size_t i : group) size = std::max(size, (points[i].p_L - centre).norm());
  MatrixXd velocities(3 * group.size(), 6);
  for (std::size_t k = 0; k < group.size(); ++k) {
    auto rows = velocities.middleRows<3>(3 * static_cast<Eigen::Index>(k));
    rows.leftCols<3>().setIdentity();
    const Vector3d arm = points[group[k]].p_L - centre;
    rows.rightCols<3>() = size > 0 ? Cross(-arm / size) : Eigen::Matrix3d::Zero();
  }
  Eigen::ColPivHouseholderQR<MatrixXd> factors;
  factors.setThreshold(kRank);
  factors.compute(velocities);
  return factors.householderQ() * MatrixXd::Identity(velocities.rows(), factors.rank());
}

}  // namespace

std::vector<RigidPoints> GroupByLink(const std::vector<ContactPoint>& points) {
  std::vector<RigidPoints> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const RigidPoints& candidate) {
      return candidate.link == points[i].link;
    });
    if (group == groups.end()) group = groups.insert(group, {points[i].link, {}, {}});
    group->points.push_back(i);
  }
  for (RigidPoints& group : groups) group.basis = BasisOf(points, group.points);
  return groups;
}

}  // namespace possibility::dynamics
