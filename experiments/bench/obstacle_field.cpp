#include "experiments/bench/obstacle_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "actions/wholebody/planar_pose.h"
#include "graph/action/random.h"

namespace possibility::experiments {
namespace {

using actions::PlanarPose;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPerPile = 16;
constexpr double kAreaOfPile = 6;     ///< m^2 of ground for each pile
constexpr double kPileRadius = 0.45;  ///< m, to the centres of its obstacles
constexpr double kSmallestSide = 8;   ///< m
constexpr double kFromCorner = 1.5;   ///< m, start and goal
constexpr double kFreeRadius = 1.5;   ///< m around start and goal where no pile is
constexpr double kShoulder = 1;       ///< m of ground beyond the bounds

class Strewer {
 public:
  Strewer(int count, std::uint64_t seed) : generator_(seed) {
    const int piles = (count + kPerPile - 1) / kPerPile;
    side_ = std::max(kSmallestSide, std::sqrt(piles * kAreaOfPile));
    scenario_.name = fmt::format("field_of_{}", count);
    scenario_.seed = seed;
    scenario_.environment.bounds = {Vector2d::Zero(), Vector2d::Constant(side_)};
    const double heading = std::numbers::pi / 4;
    scenario_.start = {"walk", kFromCorner, kFromCorner, 0, heading};
    scenario_.goals = {{"walk", side_ - kFromCorner, side_ - kFromCorner, 0, heading}};
    AddGround();
    for (int pile = 0; pile < piles; ++pile) {
      AddPile(std::min(kPerPile, count - pile * kPerPile));
    }
  }

  models::Scenario Take() { return std::move(scenario_); }

 private:
  double Between(double low, double high) { return graph::UniformReal(low, high, &generator_); }

  void AddGround() {
    const double size = side_ + 2 * kShoulder;
    Add(models::Shape::Box({size, size, 0.5}), PlanarPose{side_ / 2, side_ / 2, 0}.At(-0.25));
    scenario_.environment.obstacles.back().is_ground = true;
  }

  void Add(models::Shape shape, const Eigen::Isometry3d& X_WO) {
    models::Environment& world = scenario_.environment;
    world.obstacles.push_back(
        {fmt::format("obstacle_{}", world.obstacles.size()), std::move(shape), X_WO, false});
  }

  void AddPile(int count) {
    const Vector2d centre = FreePlace();
    const double kind = Between(0, 1);
    for (int i = 0; i < count; ++i) {
      const double radius = kPileRadius * std::sqrt(Between(0, 1));
      const double angle = Between(-std::numbers::pi, std::numbers::pi);
      const PlanarPose place{centre.x() + radius * std::cos(angle),
                             centre.y() + radius * std::sin(angle),
                             Between(-std::numbers::pi, std::numbers::pi)};
      if (kind < 0.4) {
        AddRubble(place);
      } else if (kind < 0.7) {
        AddPillar(place);
      } else {
        AddBar(place);
      }
    }
  }

  Vector2d FreePlace() {
    const auto far_from = [](const models::Stance& stance, const Vector2d& p) {
      return (Vector2d(stance.x, stance.y) - p).norm() > kFreeRadius + kPileRadius;
    };
    while (true) {
      const double x = Between(0, side_);
      const double y = Between(0, side_);
      const Vector2d p(x, y);
      if (far_from(scenario_.start, p) && far_from(scenario_.goals.front(), p)) return p;
    }
  }

  void AddRubble(const PlanarPose& place) {
    const double length = Between(0.05, 0.25);
    const double width = Between(0.05, 0.25);
    const double height = Between(0.05, 0.5);
    Add(models::Shape::Box({length, width, height}), place.At(height / 2));
  }

  void AddPillar(const PlanarPose& place) {
    const double height = Between(1.3, 2);
    const double width = Between(0.03, 0.15);
    if (Between(0, 1) < 0.5) {
      Add(models::Shape::Cylinder(width / 2, height), place.At(height / 2));
    } else {
      Add(models::Shape::Box({width, width, height}), place.At(height / 2));
    }
  }

  void AddBar(const PlanarPose& place) {
    const double height = Between(0.9, 1.15);
    const double length = Between(0.3, 0.8);
    Eigen::Isometry3d X_WO = place.At(height);
    X_WO.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()));
    Add(models::Shape::Cylinder(Between(0.01, 0.04), length), X_WO);
  }

  graph::RandomGenerator generator_;
  models::Scenario scenario_;
  double side_ = 0;
};

}  // namespace

models::Scenario ObstacleField(int count, std::uint64_t seed) {
  if (count < 0) {
    throw std::invalid_argument(
        fmt::format("ObstacleField: {} obstacles, expected at least none", count));
  }
  return Strewer(count, seed).Take();
}

}  // namespace possibility::experiments
