#pragma once

#include <fmt/format.h>

#include <random>

#include "actions/wholebody/planar_pose.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// A floor with a pit, and `count` boxes and bars at random places, some of them low, some hanging.
inline models::Environment RandomEnvironment(std::mt19937* generator, int count) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto between = [&](double low, double high) {
    return low + (high - low) * unit(*generator);
  };
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3));
  const auto add = [&](const std::string& name, const models::Shape& shape,
                       const Eigen::Vector3d& position, double yaw, bool is_ground) {
    models::Obstacle obstacle;
    obstacle.name = name;
    obstacle.shape = shape;
    obstacle.X_WO = PlanarPose{position.x(), position.y(), yaw}.At(position.z());
    obstacle.is_ground = is_ground;
    environment.obstacles.push_back(obstacle);
  };
  // Two floor slabs with a gap between them somewhere.
  const double gap = between(-2, 2), width = between(0, 0.3);
  add("floor_left", models::Shape::Box({gap + 4, 8, 0.5}), {(gap - 4) / 2, 0, -0.25}, 0, true);
  add("floor_right", models::Shape::Box({4 - gap - width, 8, 0.5}),
      {(4 + gap + width) / 2, 0, -0.25}, 0, true);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d size(between(0.05, 0.8), between(0.05, 0.8), between(0.02, 1.2));
    const double height = unit(*generator) < 0.5 ? size.z() / 2 : between(0.7, 1.6);
    add(fmt::format("box_{}", i), models::Shape::Box(size),
        {between(-3, 3), between(-3, 3), height}, between(-3, 3), false);
  }
  return environment;
}

inline PlanarPose RandomStance(std::mt19937* generator, double extent) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {extent * unit(*generator), extent * unit(*generator),
          static_cast<double>(EIGEN_PI) * unit(*generator)};
}

}  // namespace possibility::actions
