#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "dynamics/tree/contact_point.h"

namespace possibility::dynamics {

/// Orthonormal basis Q (3 points x columns) of the velocities that the links, as rigid bodies, can
/// give to points of theirs. Columns per link: 3 for one point, 5 for points on a line, else 6.
/// Forces at the points that are orthogonal to Q are without effect on the links: forces of least
/// norm have none of them.
class RigidBasis {
 public:
  /// Takes points as they are; quick if they are those of the last call.
  void SetPoints(const std::vector<ContactPoint>& points);
  /// Turns Q to world axes. `X_WL`: poses of all links.
  void SetPoses(const std::vector<Eigen::Isometry3d>& X_WL);

  Eigen::Index columns() const { return columns_; }
  /// Q' x, columns, and Q x, 3 points.
  Eigen::VectorXd Reduced(const Eigen::VectorXd& x) const;
  Eigen::VectorXd Expanded(const Eigen::VectorXd& x) const;
  /// Writes J' Q (n x columns) for J (3 points x n).
  void Reduce(const Eigen::MatrixXd& J, Eigen::MatrixXd* reduced) const;

 private:
  /// Points of one link.
  struct Group {
    int link = 0;
    std::vector<std::size_t> points;
    Eigen::Index column = 0;  ///< first one
    Eigen::MatrixXd basis;    ///< 3 points x rank, link axes
  };
  /// Rows of a point in the columns of its group.
  auto Block(const Group& group, std::size_t point) const {
    return basis_.block<3, Eigen::Dynamic>(3 * static_cast<Eigen::Index>(point), 0, 3,
                                           group.basis.cols());
  }

  std::vector<ContactPoint> points_;
  std::vector<Group> groups_;
  Eigen::Index columns_ = 0;
  Eigen::MatrixXd basis_;  ///< 3 points x 6, world axes: Q without its zeros
};

}  // namespace possibility::dynamics
