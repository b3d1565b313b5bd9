#include "models/world/local_world.h"

#include <gtest/gtest.h>

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

Obstacle BoxAt(const Vector3d& place, bool is_ground) {
  Obstacle box;
  box.shape = Shape::Box({1, 1, 1});
  box.X_WO.translation() = place;
  box.is_ground = is_ground;
  return box;
}

/// Two slabs of floor 10 m apart, and a box over each.
Environment TwoPlaces() {
  Environment environment;
  environment.obstacles = {BoxAt({0, 0, -0.5}, true), BoxAt({10, 0, -0.5}, true),
                           BoxAt({0, 0, 1}, false), BoxAt({10, 0, 1}, false)};
  return environment;
}

std::string Seen(const Environment& environment, const WorldReach& reach) {
  const GroundMap ground(environment);
  return LocalWorld(environment, ground).Within(reach);
}

AlignedBox3d Around(const Vector3d& p) {
  return {p - Vector3d::Constant(0.1), p + Vector3d::Constant(0.1)};
}

const WorldReach kHere{Around({0, 0, 1}), Around({0, 0, 0})};

TEST(LocalWorld, ChangesFarAwayAreNotSeen) {
  Environment moved = TwoPlaces();
  moved.obstacles[1].X_WO.translation().x() += 0.5;
  moved.obstacles[3].X_WO.translation().x() += 0.5;
  EXPECT_EQ(Seen(moved, kHere), Seen(TwoPlaces(), kHere));
}

TEST(LocalWorld, EveryChangeWithinReachIsSeen) {
  const std::string before = Seen(TwoPlaces(), kHere);
  const auto expect_seen = [&](const auto& change) {
    Environment changed = TwoPlaces();
    change(&changed);
    EXPECT_NE(Seen(changed, kHere), before);
  };
  expect_seen([](Environment* e) { e->obstacles[2].X_WO.translation().x() += 1e-12; });
  expect_seen([](Environment* e) { e->obstacles[2].shape.size.z() += 1e-12; });
  expect_seen([](Environment* e) { e->obstacles[0].friction = 0.3; });
  expect_seen([](Environment* e) { e->obstacles[0].X_WO.translation().y() += 0.1; });
  expect_seen([](Environment* e) { e->obstacles.erase(e->obstacles.begin() + 2); });
  expect_seen([](Environment* e) { e->obstacles.push_back(BoxAt({0.55, 0, 1}, false)); });
}

TEST(LocalWorld, SomethingThatComesWithinReachIsSeen) {
  Environment changed = TwoPlaces();
  changed.obstacles[3].X_WO.translation().x() = 0.7;
  EXPECT_EQ(Seen(changed, kHere), Seen(TwoPlaces(), kHere)) << "0.1 m away";
  changed.obstacles[3].X_WO.translation().x() = 0.59;
  EXPECT_NE(Seen(changed, kHere), Seen(TwoPlaces(), kHere));
}

TEST(LocalWorld, SolidsThatAreNoGroundDoNotCountAsGround) {
  const WorldReach ground_alone{{}, Around({0, 0, 0.45})};
  Environment without = TwoPlaces();
  without.obstacles.erase(without.obstacles.begin() + 2);
  EXPECT_EQ(Seen(without, ground_alone), Seen(TwoPlaces(), ground_alone));
}

TEST(LocalWorld, NamesDoNotCount) {
  Environment named = TwoPlaces();
  named.obstacles[2].name = "beam";
  EXPECT_EQ(Seen(named, kHere), Seen(TwoPlaces(), kHere));
}

TEST(LocalWorld, PlanesThatFarGroundChangesAreSeen) {
  // A slab 0.5e-6 m lower far away becomes part of the level, whose height is the lower one.
  Environment merged = TwoPlaces();
  merged.obstacles[1].X_WO.translation().z() -= 0.5e-6;
  EXPECT_NE(Seen(merged, kHere), Seen(TwoPlaces(), kHere));
}

}  // namespace
}  // namespace possibility::models
