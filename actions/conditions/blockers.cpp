#include "actions/conditions/blockers.h"

#include <algorithm>

#include "models/world/collision.h"

namespace possibility::actions {

std::vector<std::string> Blockers(const models::Environment& environment,
                                  const std::vector<models::PosedShape>& shapes) {
  std::vector<std::string> names;
  for (const models::Obstacle& obstacle : environment.obstacles) {
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
