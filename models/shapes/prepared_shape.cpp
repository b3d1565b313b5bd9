#include "models/shapes/prepared_shape.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>

#include <limits>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

btVector3 ToBullet(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::shared_ptr<const btConvexShape> BulletCore(const Shape& core, const Vector3d& half_extents) {
  std::shared_ptr<btConvexShape> bullet;
  switch (core.type) {
    case ShapeType::kCylinder:
      bullet = std::make_shared<btCylinderShapeZ>(ToBullet(half_extents));
      break;
    case ShapeType::kConvexMesh: {
      auto hull = std::make_shared<btConvexHullShape>();
      for (const Vector3d& vertex : core.vertices) hull->addPoint(ToBullet(vertex), false);
      hull->recalcLocalAabb();
      bullet = std::move(hull);
      break;
    }
    default:
      bullet = std::make_shared<btBoxShape>(ToBullet(half_extents));
  }
  // Bullet rounds off or inflates shapes by a margin of centimetres unless told otherwise.
  bullet->setMargin(0);
  return bullet;
}

}  // namespace

PreparedShape::PreparedShape(const Shape& shape) {
  Shape core = shape;
  if (shape.type == ShapeType::kSphere || shape.type == ShapeType::kCapsule) {
    radius_ = shape.radius;
    core = Shape();
    if (shape.type == ShapeType::kCapsule) core.size.z() = shape.length;
  }
  core_is_box_ = core.type == ShapeType::kBox;
  if (core.type == ShapeType::kConvexMesh) {
    if (core.vertices.empty()) throw InputError("convex mesh: no vertices, expected at least one");
    p_SC_ = core.Bounds(Eigen::Isometry3d::Identity()).center();
    for (Vector3d& vertex : core.vertices) vertex -= p_SC_;
  }
  half_extents_ = core.Bounds(Eigen::Isometry3d::Identity()).sizes() / 2;
  bullet_core_ = BulletCore(core, half_extents_);
  core_ = std::make_shared<const Shape>(std::move(core));
}

Vector3d PreparedShape::CoreSupport(const Vector3d& direction) const {
  return core_->Support(direction);
}

Eigen::Isometry3d PreparedShape::CorePose(const Eigen::Isometry3d& X_WS) const {
  Eigen::Isometry3d X_WC = X_WS;
  X_WC.translation() += X_WS.linear() * p_SC_;
  return X_WC;
}

Eigen::AlignedBox3d PreparedShape::OuterBounds(const Eigen::Isometry3d& X_WC) const {
  const Vector3d reach = X_WC.linear().cwiseAbs() * half_extents_ + Vector3d::Constant(radius_);
  if (!reach.allFinite() || !X_WC.translation().allFinite()) {
    const Vector3d everywhere = Vector3d::Constant(std::numeric_limits<double>::infinity());
    return {-everywhere, everywhere};
  }
  return {X_WC.translation() - reach, X_WC.translation() + reach};
}

}  // namespace possibility::models
