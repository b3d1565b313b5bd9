#include "models/shapes/upright_boxes.h"

#include <cmath>
#include <utility>

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Largest tilt of a box that counts as upright, rad: less than a micrometre over a hundred metres.
constexpr double kMaxTilt = 1e-8;

/// Whether an axis of `a` separates the rectangles seen from above by at least `gap`. Call both
/// ways round: the separating axes of two rectangles are the normals of their sides.
bool SidesSeparate(const Prism& a, const Prism& b, const Vector2d& from_a_to_b, double cosine,
                   double sine, double gap) {
  const double along = std::abs(from_a_to_b.dot(a.x_axis));
  const double across = std::abs(from_a_to_b.y() * a.x_axis.x() - from_a_to_b.x() * a.x_axis.y());
  return along - a.half_extents.x() - cosine * b.half_extents.x() - sine * b.half_extents.y() >=
             gap ||
         across - a.half_extents.y() - sine * b.half_extents.x() - cosine * b.half_extents.y() >=
             gap;
}

}  // namespace

UprightBoxes::UprightBoxes(std::vector<AlignedBox3d> boxes) : boxes_(std::move(boxes)) {
  for (const AlignedBox3d& box : boxes_) {
    shapes_.emplace_back(Shape::Box(box.sizes()));
    X_SB_.emplace_back(Isometry3d::Identity());
    X_SB_.back().translation() = box.center();
  }
}

Prism::Prism(const AlignedBox3d& box, const Isometry3d& X_WS)
    : centre((X_WS * box.center()).head<2>()),
      x_axis(X_WS.linear().col(0).head<2>()),
      half_extents(box.sizes().head<2>() / 2),
      low(X_WS.translation().z() + box.min().z()),
      high(X_WS.translation().z() + box.max().z()) {}

Prism::Prism(const PreparedShape& shape, const Isometry3d& X_WC, const AlignedBox3d& bounds)
    : low(bounds.min().z()), high(bounds.max().z()) {
  const double tilt = (X_WC.linear().col(2) - Vector3d::UnitZ()).norm();
  if (tilt <= kMaxTilt) {
    centre = X_WC.translation().head<2>();
    x_axis = X_WC.linear().col(0).head<2>();
    half_extents = (shape.half_extents().array() + shape.radius()).head<2>();
  } else {
    centre = bounds.center().head<2>();
    half_extents = bounds.sizes().head<2>() / 2;
  }
}

AlignedBox3d Prism::Bounds() const {
  const Vector2d axis = x_axis.cwiseAbs();
  const Vector2d reach(axis.x() * half_extents.x() + axis.y() * half_extents.y(),
                       axis.y() * half_extents.x() + axis.x() * half_extents.y());
  return {Vector3d(centre.x() - reach.x(), centre.y() - reach.y(), low),
          Vector3d(centre.x() + reach.x(), centre.y() + reach.y(), high)};
}

bool AreApart(const Prism& a, const Prism& b, double gap) {
  if (a.low - b.high >= gap || b.low - a.high >= gap) return true;
  const double cosine = std::abs(a.x_axis.dot(b.x_axis));
  const double sine = std::abs(a.x_axis.x() * b.x_axis.y() - a.x_axis.y() * b.x_axis.x());
  const Vector2d from_a_to_b = b.centre - a.centre;
  return SidesSeparate(a, b, from_a_to_b, cosine, sine, gap) ||
         SidesSeparate(b, a, from_a_to_b, cosine, sine, gap);
}

}  // namespace possibility::models
