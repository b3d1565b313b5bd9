#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/manoeuvre.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {

inline const LocomotionModel& WalkingHubo() {
  static const LocomotionModel model = DrcHubo1Walking();
  return model;
}

/// A world of upright boxes for DRC-HUBO1 to walk in.
struct UnevenWorld {
  /// Ground from x = `from` to `to`, with its top at `z`; m.
  UnevenWorld& Ground(double from, double to, double z, double width = 3) {
    Add({to - from, width, 0.5}, {(from + to) / 2, 0, z - 0.25}, true);
    return *this;
  }
  /// A slope from (x, z) = `from` to `to`, m.
  UnevenWorld& Slope(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width = 3) {
    const Eigen::Vector2d along = to - from;
    const double angle = std::atan2(along.y(), along.x());
    const Eigen::Vector2d middle =
        (from + to) / 2 + 0.1 * Eigen::Vector2d(std::sin(angle), -std::cos(angle));
    Add({along.norm(), width, 0.2}, {middle.x(), 0, middle.y()}, true);
    environment.obstacles.back().X_WO.linear() =
        Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return *this;
  }
  UnevenWorld& Box(const Eigen::Vector3d& size, const Eigen::Vector3d& position) {
    Add(size, position, false);
    return *this;
  }
  void Add(const Eigen::Vector3d& size, const Eigen::Vector3d& position, bool is_ground) {
    models::Obstacle obstacle;
    obstacle.name = fmt::format("box {}", environment.obstacles.size());
    obstacle.shape = models::Shape::Box(size);
    obstacle.X_WO.translation() = position;
    obstacle.is_ground = is_ground;
    environment.obstacles.push_back(std::move(obstacle));
  }
  /// Six treads of 0.30 m from x = 0.3 on, and a landing.
  static UnevenWorld Stairs(double rise) {
    UnevenWorld world;
    world.Ground(-3, 0.3, 0);
    for (int i = 1; i <= 6; ++i) world.Ground(0.3 * i, 0.3 * (i + 1), rise * i, 1);
    world.Ground(2.1, 4, 6 * rise);
    return world;
  }

  /// Call it once all boxes are there.
  const World& Built() {
    environment.bounds = {Eigen::Vector2d(-2.5, -1.2), Eigen::Vector2d(5, 1.2)};
    ground = std::make_unique<models::GroundMap>(environment);
    world = {&environment, ground.get()};
    return world;
  }

  static GroundedStance StanceAt(double x, double z = 0, double y = 0) {
    GroundedStance stance;
    stance.pose = {x, y, 0};
    stance.z = z;
    return stance;
  }

  models::Environment environment;
  std::unique_ptr<models::GroundMap> ground;
  World world;
};

}  // namespace possibility::actions
