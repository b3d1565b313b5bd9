#include "actions/conditions/pelvis_clearance.h"

#include <algorithm>

namespace possibility::actions {
namespace {

/// Keeps C_N optimistic: shapes are shrunk by more than the collision checker's error, m.
constexpr double kOptimism = 0.001;

models::Shape Shrunk(models::Shape shape) {
  shape.size = (shape.size.array() - 2 * kOptimism).max(1e-6).matrix();
  shape.radius = std::max(shape.radius - kOptimism, 1e-6);
  if (shape.type == models::ShapeType::kCylinder) {
    shape.length = std::max(shape.length - 2 * kOptimism, 1e-6);
  }
  return shape;
}

}  // namespace

PelvisClearance::PelvisClearance(const models::RobotModel& robot,
                                 const models::CollisionChecker& checker)
    : checker_(&checker) {
  for (const models::PosedShape& posed : robot.links[robot.pelvis_shape_link].shapes) {
    parts_.emplace_back(models::PreparedShape(Shrunk(posed.shape)), posed.X_PS);
  }
}

bool PelvisClearance::IsFree(const Eigen::Isometry3d& X_WR) const {
  return std::all_of(parts_.begin(), parts_.end(), [&](const auto& part) {
    return checker_->IsFree(part.first, X_WR * part.second, 0);
  });
}

}  // namespace possibility::actions
