#include "actions/footholds/swing_barriers.h"

#include <algorithm>
#include <array>

#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Heights of the level ground within `away` of a box, seen from above. Empty if a slope is there.
Eigen::AlignedBox1d HeightsAbout(const models::GroundMap& ground, const std::vector<int>& planes,
                                 const AlignedBox2d& box, double away) {
  Eigen::AlignedBox1d heights;
  const double radius = box.diagonal().norm() / 2 + away;
  for (const int plane : planes) {
    if (!ground.IsNear(plane, box.center(), radius)) continue;
    if (ground.planes()[plane].normal != Vector3d::UnitZ()) return {};
    heights.extend(Eigen::Matrix<double, 1, 1>(ground.planes()[plane].HeightAt(box.center())));
  }
  return heights;
}

}  // namespace

SwingBarriers::SwingBarriers(const NominalStance& stance, const World& world,
                             const std::vector<int>& planes, const FootstepLimits& limits,
                             double reach)
    : disc_(stance) {
  for (const models::Obstacle& obstacle : world.environment->obstacles) {
    if (obstacle.is_ground) continue;
    const Eigen::AlignedBox3d box = obstacle.shape.Bounds(obstacle.X_WO);
    AlignedBox2d bounds(box.min().head<2>(), box.max().head<2>());
    // A limb swings from beside the other one to beside it again.
    const Eigen::AlignedBox1d heights = HeightsAbout(*world.ground, planes, bounds, 2 * reach);
    if (heights.isEmpty()) continue;
    bounds.min().array() -= disc_.radius();
    bounds.max().array() += disc_.radius();
    const double low = heights.min()[0];
    const double high = heights.max()[0] + std::max(limits.lift, limits.clearance);
    // The rest of it stops no swing at all these heights.
    if (box.min().z() > low + SoleDisc::kAboveSole || box.max().z() < high + SoleDisc::kAboveSole)
      continue;
    barriers_.push_back({models::PreparedShape(obstacle.shape), obstacle.X_WO, bounds, low, high});
  }
}

AlignedBox2d SwingBarriers::Bounds() const {
  AlignedBox2d bounds;
  for (const Barrier& barrier : barriers_) bounds.extend(barrier.bounds);
  return bounds;
}

/// Between both heights it does as well: the barrier is convex.
bool SwingBarriers::Stops(const Barrier& barrier, const Vector2d& p) const {
  if (!barrier.bounds.contains(p)) return false;
  const std::array<double, 2> heights = {barrier.low, barrier.high};
  return std::all_of(heights.begin(), heights.end(),
                     [&](double z) { return disc_.Hits(barrier.shape, barrier.X_WC, p, z); });
}

/// One barrier that stops the corners stops all between them.
bool SwingBarriers::Fill(const Vector2d& centre, double half) const {
  return std::any_of(barriers_.begin(), barriers_.end(), [&](const Barrier& barrier) {
    for (const double x : {-half, half}) {
      for (const double y : {-half, half}) {
        if (!Stops(barrier, centre + Vector2d(x, y))) return false;
      }
    }
    return true;
  });
}

}  // namespace possibility::actions
