#include "actions/conditions/blockers.h"

#include <algorithm>

#include "models/world/collision.h"

namespace possibility::actions {
namespace {

/// Farther apart than any rounding, m.
constexpr double kFarApart = 1e-3;

}  // namespace

std::vector<std::string> Blockers(const models::Environment& environment,
                                  const std::vector<models::PosedShape>& shapes) {
  std::vector<std::string> names;
  Eigen::AlignedBox3d around;
  for (const models::PosedShape& posed : shapes) around.extend(posed.shape.Bounds(posed.X_PS));
  for (const models::Obstacle& obstacle : environment.obstacles) {
    // All pieces of a surface have its name.
    if (!names.empty() && names.back() == obstacle.name) continue;
    const Eigen::AlignedBox3d bounds = obstacle.shape.Bounds(obstacle.X_WO);
    if (bounds.exteriorDistance(around) > kFarApart) continue;
    models::Environment single;
    single.bounds = environment.bounds;
    single.obstacles = {obstacle};
    models::CollisionChecker checker(single);
    if (std::any_of(shapes.begin(), shapes.end(), [&](const models::PosedShape& posed) {
          return !checker.IsFree(posed.shape, posed.X_PS, 0);
        })) {
      names.push_back(obstacle.name);
    }
  }
  return names;
}

}  // namespace possibility::actions
