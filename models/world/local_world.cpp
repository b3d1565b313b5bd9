#include "models/world/local_world.h"

#include "models/input/byte_text.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kTouch = 1e-4;  // m, more than the error of a distance

AlignedBox3d Grown(const AlignedBox3d& box, double by) {
  if (box.isEmpty()) return box;
  return {box.min() - Vector3d::Constant(by), box.max() + Vector3d::Constant(by)};
}

void AddSolid(const Obstacle& obstacle, ByteText* text) {
  const Shape& shape = obstacle.shape;
  text->Add('s').Add(static_cast<int>(shape.type)).Add(shape.radius).Add(shape.length);
  text->Add(shape.size).Add(shape.vertices.size());
  for (const Vector3d& vertex : shape.vertices) text->Add(vertex);
  text->Add(obstacle.X_WO.matrix()).Add(obstacle.is_ground).Add(obstacle.is_for_steps);
  text->Add(obstacle.surface >= 0).Add(obstacle.friction);
}

void AddFace(const GroundFace& face, ByteText* text) {
  text->Add('f').Add(face.friction).Add(face.corners.size());
  for (const Vector3d& corner : face.corners) text->Add(corner);
}

}  // namespace

LocalWorld::LocalWorld(const Environment& environment, const GroundMap& ground)
    : environment_(&environment), ground_(&ground) {
  for (const Obstacle& obstacle : environment.obstacles) {
    solid_bounds_.push_back(Grown(obstacle.shape.Bounds(obstacle.X_WO), kTouch));
  }
  for (const GroundFace& face : environment.faces) {
    AlignedBox3d bounds;
    for (const Vector3d& corner : face.corners) bounds.extend(corner);
    face_bounds_.push_back(Grown(bounds, kTouch));
  }
}

std::string LocalWorld::Within(const WorldReach& reach) const {
  ByteText text;
  for (std::size_t i = 0; i < solid_bounds_.size(); ++i) {
    const Obstacle& obstacle = environment_->obstacles[i];
    const bool is_met = solid_bounds_[i].intersects(reach.solids) ||
                        (obstacle.is_ground && solid_bounds_[i].intersects(reach.ground));
    if (is_met) AddSolid(obstacle, &text);
  }
  if (reach.ground.isEmpty()) return text.Take();
  for (std::size_t i = 0; i < face_bounds_.size(); ++i) {
    if (face_bounds_[i].intersects(reach.ground)) AddFace(environment_->faces[i], &text);
  }
  const double radius = reach.ground.diagonal().norm() / 2 + kTouch;
  for (const int index : ground_->PlanesNear(reach.ground.center(), radius)) {
    const GroundPlane& plane = ground_->planes()[index];
    text.Add('p').Add(plane.normal).Add(plane.offset).Add(plane.friction);
  }
  return text.Take();
}

}  // namespace possibility::models
