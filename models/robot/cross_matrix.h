#pragma once

#include <Eigen/Core>

namespace possibility::models {

/// [v] with [v] x = v x x.
inline Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace possibility::models
