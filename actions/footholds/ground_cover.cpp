#include "actions/footholds/ground_cover.h"

#include <algorithm>
#include <array>
#include <utility>

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace

GroundCover::GroundCover(const NominalStance& stance, const models::Environment& environment)
    : disc_(stance) {
  std::vector<AlignedBox3d> bounds;
  for (const models::Obstacle& obstacle : environment.obstacles) {
    models::PreparedShape shape(obstacle.shape);
    const Eigen::Isometry3d X_WC = shape.CorePose(obstacle.X_WO);
    bounds.push_back(shape.OuterBounds(X_WC));
    solids_.push_back({std::move(shape), X_WC});
  }
  tree_ = models::BoundsTree(std::move(bounds));
}

/// A solid that hits the discs about all corners hits those between them: it is convex.
bool GroundCover::Covers(const Vector2d& centre, double half, double z) const {
  const Vector3d middle(centre.x(), centre.y(), z + SoleDisc::kAboveSole);
  bool is_covered = false;
  tree_.VisitNear(AlignedBox3d(middle, middle), disc_.radius(), [&](int index) {
    const Solid& solid = solids_[index];
    const std::array<Vector2d, 4> corners = {Vector2d(-half, -half), Vector2d(half, -half),
                                             Vector2d(half, half), Vector2d(-half, half)};
    is_covered = std::all_of(corners.begin(), corners.end(), [&](const Vector2d& corner) {
      return disc_.Hits(solid.shape, solid.X_WC, centre + corner, z);
    });
    return is_covered ? -1.0 : disc_.radius();
  });
  return is_covered;
}

bool GroundCover::IsBare(const Vector2d& p, double distance, double z) const {
  const double low = z + SoleDisc::kAboveSole;
  bool is_bare = true;
  const AlignedBox3d about(Vector3d(p.x() - distance, p.y() - distance, low),
                           Vector3d(p.x() + distance, p.y() + distance, low));
  tree_.VisitNear(about, 0, [&](int) {
    is_bare = false;
    return -1.0;
  });
  return is_bare;
}

}  // namespace possibility::actions
