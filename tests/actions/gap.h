#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "actions/wholebody/planar_pose.h"
#include "models/world/scenario.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {

inline models::Obstacle Floor(double x, double y, double size_x, double size_y, double yaw) {
  models::Obstacle floor;
  floor.shape = models::Shape::Box({size_x, size_y, 0.1});
  floor.X_WO = PlanarPose{x, y, yaw}.At(-0.05);
  floor.is_ground = true;
  return floor;
}

/// Floors before x = 0 and beyond x = gap.
inline models::Environment Gap(double gap) {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -1.5), Eigen::Vector2d(3, 1.5));
  environment.obstacles = {Floor(-2, 0, 4, 4, 0), Floor(gap + 2, 0, 4, 4, 0)};
  return environment;
}

/// The widest gap that walking stances can leave ahead and crawling stances land beyond, by a jump
/// straight ahead that displaces them by `distance`.
inline double WidestGap(double distance) {
  double toes = -1, heels = 1;
  for (const auto& points : DrcHubo1Locomotion().gaits[0]->stance.bearing_points) {
    for (const Eigen::Vector2d& p : points) toes = std::max(toes, p.x());
  }
  for (const auto& points : DrcHubo1Locomotion().gaits[1]->stance.bearing_points) {
    for (const Eigen::Vector2d& p : points) heels = std::min(heels, p.x());
  }
  return distance - toes + heels;
}

}  // namespace possibility::actions
