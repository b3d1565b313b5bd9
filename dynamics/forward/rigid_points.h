#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "dynamics/tree/contact_point.h"

namespace possibility::dynamics {

/// Points of one link, and the velocities that a rigid body can give them. Forces at the points
/// that are orthogonal to these are without effect: forces of least norm have none of them.
struct RigidPoints {
  int link = 0;
  std::vector<std::size_t> points;  ///< indices into the list they come from
  /// 3 points x rank, link axes, orthonormal columns. Rank: 3 for one point, 5 on a line, else 6.
  Eigen::MatrixXd basis;

  /// 3 x rank: rows of the basis of the i-th of `points`.
  auto BasisOf(std::size_t i) const {
    return basis.middleRows<3>(3 * static_cast<Eigen::Index>(i));
  }
};

/// Groups points by their links, in the order in which the links first occur.
std::vector<RigidPoints> GroupByLink(const std::vector<ContactPoint>& points);

}  // namespace possibility::dynamics
