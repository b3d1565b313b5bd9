#include "dynamics/forward/rigid_basis.h"

#include <Eigen/QR>
#include <algorithm>

namespace possibility::dynamics {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Columns of one link: three translations, three rotations.
constexpr int kMostColumns = 6;

/// Directions below this fraction of the largest count as rounding.
constexpr double kRigidRank = 1e-9;

bool SamePoint(const ContactPoint& a, const ContactPoint& b) {
  return a.link == b.link && a.p_L == b.p_L;
}

Matrix3d Cross(const Vector3d& r) {
  Matrix3d matrix;
  matrix << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return matrix;
}

/// Of translations, and of rotations about the centre of the points (link axes).
MatrixXd OrthonormalBasis(const std::vector<Vector3d>& points) {
  const auto count = static_cast<double>(points.size());
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& p : points) centre += p / count;
  double size = 0;
  for (const Vector3d& p : points) size = std::max(size, (p - centre).norm());
  MatrixXd velocities(3 * points.size(), kMostColumns);
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto rows = velocities.middleRows<3>(3 * static_cast<Index>(k));
    rows.leftCols<3>().setIdentity();
    const Vector3d arm = points[k] - centre;
    rows.rightCols<3>() = size > 0 ? Cross(-arm / size) : Matrix3d(Matrix3d::Zero());
  }
  Eigen::ColPivHouseholderQR<MatrixXd> factors;
  factors.setThreshold(kRigidRank);
  factors.compute(velocities);
  return factors.householderQ() * MatrixXd::Identity(velocities.rows(), factors.rank());
}

}  // namespace

void RigidBasis::SetPoints(const std::vector<ContactPoint>& points) {
  if (std::equal(points.begin(), points.end(), points_.begin(), points_.end(), &SamePoint)) return;
  points_ = points;
  groups_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& candidate) {
      return candidate.link == points[i].link;
    });
    if (group == groups_.end()) group = groups_.insert(group, Group{points[i].link, {}, 0, {}});
    group->points.push_back(i);
  }
  columns_ = 0;
  for (Group& group : groups_) {
    std::vector<Vector3d> places;
    for (const std::size_t i : group.points) places.push_back(points[i].p_L);
    group.basis = OrthonormalBasis(places);
    group.column = columns_;
    columns_ += group.basis.cols();
  }
  basis_.setZero(3 * points.size(), kMostColumns);
}

void RigidBasis::SetPoses(const std::vector<Eigen::Isometry3d>& X_WL) {
  for (const Group& group : groups_) {
    const Matrix3d& R = X_WL[group.link].linear();
    const Index rank = group.basis.cols();
    for (std::size_t k = 0; k < group.points.size(); ++k) {
      const Index row = 3 * static_cast<Index>(group.points[k]);
      basis_.block<3, Eigen::Dynamic>(row, 0, 3, rank).noalias() =
          R * group.basis.middleRows<3>(3 * static_cast<Index>(k));
    }
  }
}

VectorXd RigidBasis::Reduced(const VectorXd& x) const {
  VectorXd reduced = VectorXd::Zero(columns_);
  for (const Group& group : groups_) {
    auto part = reduced.segment(group.column, group.basis.cols());
    for (const std::size_t point : group.points) {
      part.noalias() += Block(group, point).transpose() * x.segment<3>(3 * point);
    }
  }
  return reduced;
}

VectorXd RigidBasis::Expanded(const VectorXd& x) const {
  VectorXd expanded(basis_.rows());
  for (const Group& group : groups_) {
    const auto part = x.segment(group.column, group.basis.cols());
    for (const std::size_t point : group.points) {
      expanded.segment<3>(3 * point).noalias() = Block(group, point) * part;
    }
  }
  return expanded;
}

void RigidBasis::Reduce(const MatrixXd& J, MatrixXd* reduced) const {
  reduced->setZero(J.cols(), columns_);
  for (const Group& group : groups_) {
    auto part = reduced->middleCols(group.column, group.basis.cols());
    for (const std::size_t point : group.points) {
      // Three products an entry: Eigen's blocked product would spend more on packing.
      part += J.middleRows<3>(3 * point).transpose().lazyProduct(Block(group, point));
    }
  }
}

}  // namespace possibility::dynamics
