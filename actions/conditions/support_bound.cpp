#include "actions/conditions/support_bound.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr int kFaces = 6;

double CoordinateAt(int i) { return -1 + 2.0 * i / SupportBound::kCells; }

/// Faces 0 to 2: +x, +y, +z; 3 to 5: -x, -y, -z.
Vector3d PointOnCube(int face, double u, double v) {
  const int axis = face % 3;
  Vector3d p;
  p[axis] = face < 3 ? 1 : -1;
  p[(axis + 1) % 3] = u;
  p[(axis + 2) % 3] = v;
  return p;
}

/// Where a coordinate in [-1, 1] lies in the grid: the cell, and the part of it that is passed.
std::pair<int, double> CellOf(double coordinate) {
  const double at = (coordinate + 1) / 2 * SupportBound::kCells;
  const int cell = std::clamp(static_cast<int>(at), 0, SupportBound::kCells - 1);
  return {cell, std::clamp(at - cell, 0.0, 1.0)};
}

}  // namespace

SupportBound::SupportBound(const std::function<double(const Vector3d& d)>& bound)
    : values_(kFaces * (kCells + 1) * (kCells + 1)) {
  for (int face = 0; face < kFaces; ++face) {
    for (int i = 0; i <= kCells; ++i) {
      for (int j = 0; j <= kCells; ++j) {
        At(face, i, j) = bound(PointOnCube(face, CoordinateAt(i), CoordinateAt(j)));
      }
    }
  }
}

double SupportBound::operator()(const Vector3d& d) const {
  int axis = 0;
  const double size = d.cwiseAbs().maxCoeff(&axis);
  if (!(size > 0)) return 0;
  const int face = d[axis] > 0 ? axis : axis + 3;
  const auto [i, s] = CellOf(d[(axis + 1) % 3] / size);
  const auto [j, t] = CellOf(d[(axis + 2) % 3] / size);
  const double near = (1 - t) * At(face, i, j) + t * At(face, i, j + 1);
  const double far = (1 - t) * At(face, i + 1, j) + t * At(face, i + 1, j + 1);
  return size * ((1 - s) * near + s * far);
}

}  // namespace possibility::actions
