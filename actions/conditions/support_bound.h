#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace possibility::actions {

/// An upper bound of a set's support function h(d) = sup d'x over the set, for all directions d.
///
/// The bound is kept at points of a grid on the surface of the cube [-1, 1]^3. Between them it is
/// interpolated: h is convex and positively homogeneous, so that the interpolation is never below
/// it (Rockafellar, Convex Analysis, section 13).
class SupportBound {
 public:
  /// Cells along an edge of the cube. With 16 the bound of a ball is at most 0.4 % above it.
  static constexpr int kCells = 16;

  /// `bound`: at least h(d), for any d.
  explicit SupportBound(const std::function<double(const Eigen::Vector3d& d)>& bound);

  /// At least h(d); d need not be a unit vector.
  double operator()(const Eigen::Vector3d& d) const;

 private:
  double& At(int face, int i, int j) {
    return values_[(face * (kCells + 1) + i) * (kCells + 1) + j];
  }
  double At(int face, int i, int j) const {
    return values_[(face * (kCells + 1) + i) * (kCells + 1) + j];
  }

  std::vector<double> values_;
};

}  // namespace possibility::actions
