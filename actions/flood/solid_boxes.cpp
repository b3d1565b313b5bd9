#include "actions/flood/solid_boxes.h"

#include <utility>

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Largest tilt of an upright box, rad, and a margin for that tilt and rounding, m.
constexpr double kMaxTilt = 1e-8;
constexpr double kTouchingMargin = 1e-6;

}  // namespace

SolidBoxes::SolidBoxes(const models::Environment& environment) {
  std::vector<AlignedBox3d> bounds;
  for (const models::Obstacle& obstacle : environment.obstacles) {
    const Eigen::Isometry3d& X_WO = obstacle.X_WO;
    if (obstacle.shape.type != models::ShapeType::kBox) continue;
    if (!((X_WO.linear().col(2) - Vector3d::UnitZ()).norm() <= kMaxTilt)) continue;
    Eigen::Isometry2d X_WB = Eigen::Isometry2d::Identity();
    X_WB.linear() = X_WO.linear().topLeftCorner<2, 2>();
    X_WB.translation() = X_WO.translation().head<2>();
    const Vector3d half = obstacle.shape.size / 2 - Vector3d::Constant(kTouchingMargin);
    const double middle = X_WO.translation().z();
    boxes_.push_back({X_WB.inverse(), half.head<2>(), middle - half.z(), middle + half.z()});
    bounds.push_back(obstacle.shape.Bounds(X_WO));
  }
  tree_ = models::BoundsTree(std::move(bounds));
}

bool SolidBoxes::Holds(const Box& solid, const AlignedBox3d& box) {
  if (box.min().z() < solid.low || box.max().z() > solid.high) return false;
  for (const double x : {box.min().x(), box.max().x()}) {
    for (const double y : {box.min().y(), box.max().y()}) {
      const Vector2d p_B = solid.X_BW * Vector2d(x, y);
      if ((p_B.cwiseAbs().array() > solid.half_extents.array()).any()) return false;
    }
  }
  return true;
}

bool SolidBoxes::OneHolds(const AlignedBox3d& box) const {
  bool holds = false;
  const AlignedBox3d middle(Vector3d(box.center()), Vector3d(box.center()));
  tree_.VisitNear(middle, 0, [&](int i) {
    holds = Holds(boxes_[i], box);
    return holds ? -1.0 : 0.0;
  });
  return holds;
}

}  // namespace possibility::actions
