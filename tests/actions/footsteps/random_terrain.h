#pragma once

#include <cmath>
#include <random>

#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {

/// A floor, random ground, and a floor again. Ground: strips and boards at random heights, tilted
/// or not, with gaps between them.
class RandomTerrain {
 public:
  explicit RandomTerrain(unsigned seed) : random_(seed) {
    world_.Ground(-3, 0, 0);
    const double length = Uniform(0.8, 2);
    const double roughness = Uniform(0, 0.14);
    const double tilt = random_() % 2 == 0 ? 0 : Uniform(0, 0.3);
    for (double x = 0; x < length;) {
      const double size = Uniform(0.25, 0.5);
      if (random_() % 2 == 0) {
        AddStrip(x, size, roughness, tilt);
      } else {
        AddBoards(x, size, roughness, tilt);
      }
      x += size + (random_() % 3 == 0 ? Uniform(0, 0.12) : 0);
      end_ = x;
    }
    world_.Ground(end_, end_ + 2.5, 0);
    world_.environment.bounds = {Eigen::Vector2d(-2, -0.8), Eigen::Vector2d(end_ + 2, 0.8)};
  }

  double goal_x() const { return end_ + 0.8; }
  UnevenWorld& world() { return world_; }

  models::Scenario Scenario() const {
    models::Scenario scenario = ShippedScenario("crack");
    scenario.environment = world_.environment;
    scenario.start.x = -0.8;
    scenario.start.y = 0;
    scenario.goals[0].x = goal_x();
    scenario.goals[0].y = 0;
    return scenario;
  }

 private:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void AddStrip(double x, double size, double roughness, double tilt) {
    Add({size, 1.6, 0.1}, {x + size / 2, 0, Uniform(-roughness, roughness) - 0.05}, tilt);
  }
  void AddBoards(double x, double size, double roughness, double tilt) {
    for (const double y : {-0.22, 0.22}) {
      Add({size, 0.42, 0.06}, {x + size / 2, y, Uniform(-roughness, roughness) - 0.03}, tilt);
    }
  }
  void Add(const Eigen::Vector3d& size, const Eigen::Vector3d& position, double tilt) {
    world_.Add(size, position, true);
    const Eigen::Vector3d axis = Eigen::Vector3d(Uniform(-1, 1), Uniform(-1, 1), 0).normalized();
    world_.environment.obstacles.back().X_WO.linear() =
        Eigen::AngleAxisd(Uniform(0, tilt), axis).toRotationMatrix();
  }

  std::mt19937 random_;
  UnevenWorld world_;
  double end_ = 0;
};

}  // namespace possibility::actions
