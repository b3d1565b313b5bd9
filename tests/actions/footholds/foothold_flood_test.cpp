#include "actions/footholds/foothold_flood.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>

#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

class FootholdFloodTest : public ::testing::Test {
 protected:
  double Random(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// Banks at both ends, and stones or strips of any sizes and heights between them.
  UnevenWorld RandomTerrain() {
    UnevenWorld world;
    world.Ground(-3, 0, 0).Ground(Random(1.5, 3), 5, Random(0, 0.3));
    const bool are_stones = Random(0, 1) < 0.5;
    for (double x = 0; x < 3; x += Random(0.1, 0.5)) {
      const double z = 0.05 * std::floor(Random(0, 6));
      if (are_stones) {
        const Eigen::Vector3d size(Random(0.1, 0.6), Random(0.1, 0.8), 0.5);
        world.Add(size, {x, Random(-0.5, 0.5), z - 0.25}, true);
      } else {
        world.Ground(x, x + Random(0.05, 0.5), z);
      }
    }
    return world;
  }

  /// Banks at both ends, and boards of any tilt between them.
  UnevenWorld RandomBoards() {
    UnevenWorld world;
    world.Ground(-3, 0, 0).Ground(Random(1.5, 3), 5, Random(0, 0.3));
    for (double x = 0.2; x < 3; x += Random(0.2, 0.5)) {
      world.Add({Random(0.2, 0.7), Random(0.3, 1), 0.1}, {x, Random(-0.4, 0.4), Random(-0.1, 0.3)},
                true);
      world.environment.obstacles.back().X_WO.linear() =
          (Eigen::AngleAxisd(Random(-3, 3), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(Random(0, 0.4), Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
    }
    return world;
  }

  bool Bears(const models::GroundMap& ground, int limb, int plane, const Foothold& place) const {
    const Eigen::Isometry3d X_WS = FrameOf(stance_, limb, place);
    for (const Eigen::Vector2d& p : stance_.bearing_points[limb]) {
      const Eigen::Vector3d there = X_WS * Eigen::Vector3d(p.x(), p.y(), 0);
      if (ground.Clearance(plane, there.head<2>()) < limits_.margin) return false;
    }
    return true;
  }

  /// Whether no solid stands where the sole is, a little above its ground.
  bool IsBare(const models::CollisionChecker& checker, int limb, const Foothold& place) const {
    Eigen::AlignedBox2d sole;
    for (const Eigen::Vector2d& p : stance_.bearing_points[limb]) sole.extend(p);
    const Eigen::Vector2d centre = sole.center();
    const models::Shape slice = models::Shape::Box({sole.sizes().x(), sole.sizes().y(), 0.002});
    return checker.IsFree(
        slice, FrameOf(stance_, limb, place) * Eigen::Translation3d(centre.x(), centre.y(), 0.005),
        0);
  }

  /// A step of the family, drawn at random; whether it leads to ground.
  bool Step(const World& world, const models::CollisionChecker& checker, int limb,
            const Foothold& other, Foothold* place) {
    const double side = stance_.patch_centres[limb].y() > 0 ? 1 : -1;
    const PlanarPose displacement{Random(-limits_.forward, limits_.forward),
                                  side * Random(-0.1, 1) * limits_.lateral,
                                  Random(-limits_.turn, limits_.turn)};
    const double shift = Random(-FootholdGround::kMostShift, FootholdGround::kMostShift);
    const PlanarPose there = other.stance * displacement * PlanarPose{shift, 0, 0};
    if (!world.environment->bounds.contains(there.position())) return false;
    const Eigen::Vector2d centre = there * Eigen::Vector2d(stance_.patch_centres[limb].head<2>());
    const std::vector<models::GroundPlane>& planes = world.ground->planes();
    // Mostly below the centre, but a sole may straddle a gap.
    std::vector<int> below =
        world.ground->PlanesAt(centre, other.z - limits_.rise, other.z + limits_.rise);
    if (below.empty()) below = {static_cast<int>(Random(0, static_cast<double>(planes.size())))};
    const int plane = below[static_cast<std::size_t>(Random(0, static_cast<double>(below.size())))];
    *place = {there, planes[plane].HeightAt(centre), planes[plane].normal, planes[plane].offset};
    return std::abs(place->z - other.z) <= limits_.rise &&
           Bears(*world.ground, limb, plane, *place) && IsBare(checker, limb, *place);
  }

  FootholdFlood FloodOf(const World& world, const GroundedStance& start,
                        const CancellationToken& cancellation = {}) const {
    return {stance_, world,   GentlePlanes(DrcHubo1(), *world.ground),
            limits_, {start}, cancellation};
  }

  bool IsReached(UnevenWorld* world, const GroundedStance& goal) const {
    return FloodOf(world->Built(), UnevenWorld::StanceAt(-1)).Reaches(goal);
  }

  const NominalStance& stance_ = WalkingHubo().gaits[0]->stance;
  FootstepLimits limits_ = FootstepLimits::Of(DrcHubo1(), stance_);
  std::mt19937 random_{20};
};

TEST_F(FootholdFloodTest, WhatStepsReachIsNeverDenied) {
  int steps = 0, away = 0;
  for (int terrain = 0; terrain < 18; ++terrain) {
    UnevenWorld uneven = terrain % 3 > 0 ? RandomTerrain() : RandomBoards();
    const World& world = uneven.Built();
    const GroundedStance start = UnevenWorld::StanceAt(-0.4);
    const FootholdFlood flood = FloodOf(world, start);
    const models::CollisionChecker checker(*world.environment);
    std::array<Foothold, 2> feet;
    feet.fill({start.pose, start.z});
    int limb = 0;
    for (int attempt = 0; attempt < 12000; ++attempt) {
      Foothold place;
      if (!Step(world, checker, limb, feet[1 - limb], &place)) continue;
      ASSERT_TRUE(flood.Reaches(limb, place))
          << "terrain " << terrain << ": " << place.stance.x << " " << place.stance.y << " "
          << place.stance.yaw << " at " << place.z;
      feet[limb] = place;
      limb = 1 - limb;
      ++steps;
      away += place.z > 0;
    }
  }
  EXPECT_GT(steps, 3000);
  EXPECT_GT(away, 100);
}

/// From either side of a gap, and of a beam, in turn.
TEST_F(FootholdFloodTest, ARestartReachesWhatANewFloodReaches) {
  for (int terrain = 0; terrain < 6; ++terrain) {
    UnevenWorld uneven = terrain % 2 > 0 ? RandomTerrain() : RandomBoards();
    uneven.Ground(-3, 0.2, 0).Ground(1.4, 6, 0).Box({0.1, 6, 1.2}, {-1.5, 0, 0.6});
    const World& world = uneven.Built();
    FootholdFlood flood = FloodOf(world, UnevenWorld::StanceAt(-0.4));
    for (const double x : {-2.2, 3.0, -0.4}) {
      flood.Restart({UnevenWorld::StanceAt(x)});
      const FootholdFlood fresh = FloodOf(world, UnevenWorld::StanceAt(x));
      for (int i = 0; i < 2000; ++i) {
        const Foothold place{{Random(-2.5, 5), Random(-1.2, 1.2), Random(-3, 3)}, 0};
        ASSERT_EQ(flood.Reaches(i % 2, place), fresh.Reaches(i % 2, place))
            << "terrain " << terrain << " from " << x << ": " << place.stance.x << " "
            << place.stance.y;
      }
    }
  }
}

TEST_F(FootholdFloodTest, AWideGapAHighStepAndSmallStonesAreDenied) {
  const double reach = FootholdFlood::ReachOf(stance_, limits_);
  for (const bool is_wide : {false, true}) {
    UnevenWorld gap;
    gap.Ground(-3, 0, 0).Ground(is_wide ? reach + 0.1 : 0.2, 5, 0);
    EXPECT_TRUE(IsReached(&gap, UnevenWorld::StanceAt(-2)));
    EXPECT_EQ(IsReached(&gap, UnevenWorld::StanceAt(2)), !is_wide);
  }
  for (const double rise : {0.1, 0.2}) {
    UnevenWorld stairs = UnevenWorld::Stairs(rise);
    EXPECT_EQ(IsReached(&stairs, UnevenWorld::StanceAt(3, 6 * rise)), rise < limits_.rise);
  }
  for (const double size : {0.1, 0.4}) {
    UnevenWorld stones;
    stones.Ground(-3, 0, 0).Ground(2, 5, 0);
    for (double x = 0.25; x < 1.9; x += 0.45) stones.Add({size, 0.1, 0.5}, {x, 0, -0.25}, true);
    EXPECT_FALSE(IsReached(&stones, UnevenWorld::StanceAt(3)));
    UnevenWorld wider;
    wider.Ground(-3, 0, 0).Ground(2, 5, 0);
    for (double x = 0.25; x < 1.9; x += 0.45) {
      wider.Add({size, size, 0.5}, {x, 0.1, -0.25}, true);
      wider.Add({size, size, 0.5}, {x, -0.1, -0.25}, true);
    }
    EXPECT_EQ(IsReached(&wider, UnevenWorld::StanceAt(3)), size > 0.3);
  }
}

TEST_F(FootholdFloodTest, TheFloorUnderAPalletIsDenied) {
  for (const bool bears : {false, true}) {
    UnevenWorld uneven;
    uneven.Ground(-3, 6, 0);
    uneven.Add({0.8, 3, 0.1}, {1, 0, 0.05}, bears);
    const FootholdFlood flood = FloodOf(uneven.Built(), UnevenWorld::StanceAt(-1));
    for (int i = 0; i < 500; ++i) {
      const PlanarPose on{Random(0.8, 1.2), Random(-0.5, 0.5), Random(-3, 3)};
      EXPECT_FALSE(flood.Reaches(0, {on, 0}));
      EXPECT_EQ(flood.Reaches(0, {on, 0.1}), bears);
      // Without a place on the pallet it is too far to the other side.
      EXPECT_EQ(flood.Reaches(0, {PlanarPose{Random(2, 4), on.y, on.yaw}, 0}), bears);
    }
  }
}

/// Boxes on level ground, some of which no swing passes. Every step places a foot where it is free,
/// and swings it there without a hit.
TEST_F(FootholdFloodTest, WhatSwingsReachBetweenBoxesIsNeverDenied) {
  int steps = 0, denials = 0;
  for (int terrain = 0; terrain < 12; ++terrain) {
    UnevenWorld uneven;
    uneven.Ground(-3, 6, 0);
    for (int box = 0; box < 14; ++box) {
      const double height = Random(0.05, 0.6);
      uneven.Box({Random(0.02, 0.3), Random(0.1, 1.2), height},
                 {Random(0, 4), Random(-1.2, 1.2), height / 2});
      uneven.environment.obstacles.back().X_WO.linear() =
          Eigen::AngleAxisd(Random(-3, 3), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    }
    const World& world = uneven.Built();
    const FootholdGround ground(DrcHubo1(), stance_, world, limits_.margin);
    const GroundedStance start = UnevenWorld::StanceAt(-1);
    const FootholdFlood flood = FloodOf(world, start);
    const models::CollisionChecker checker(*world.environment);
    std::array<Foothold, 2> feet;
    feet.fill({start.pose, start.z});
    int limb = 0;
    for (int attempt = 0; attempt < 1500; ++attempt) {
      Foothold place;
      if (!Step(world, checker, limb, feet[1 - limb], &place)) continue;
      const std::optional<Foothold> there = ground.Place(limb, place.stance, 0);
      if (!there || !world.environment->bounds.contains(there->stance.position())) continue;
      if (!ground.LiftBetween(limb, feet[limb], *there, limits_.clearance, limits_.lift)) continue;
      ASSERT_TRUE(flood.Reaches(limb, *there))
          << "terrain " << terrain << ": " << there->stance.x << " " << there->stance.y;
      feet[limb] = *there;
      limb = 1 - limb;
      ++steps;
    }
    denials += !flood.Reaches(UnevenWorld::StanceAt(4.5));
  }
  EXPECT_GT(steps, 1500);
  EXPECT_LT(denials, 12);
}

/// Between walls, 2.4 m apart.
TEST_F(FootholdFloodTest, ABeamHigherThanEverySwingIsDenied) {
  const auto is_reached = [&](double height, double bottom, double width, double yaw) {
    UnevenWorld world;
    world.Ground(-4, 6, 0);
    for (const double y : {-1.25, 1.25}) world.Box({10, 0.1, 1}, {1, y, 0.5});
    world.Box({0.1, width, height - bottom}, {1, 0, (height + bottom) / 2});
    world.environment.obstacles.back().X_WO.linear() =
        Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return IsReached(&world, UnevenWorld::StanceAt(3));
  };
  const double lift = limits_.lift;
  EXPECT_FALSE(is_reached(lift + 0.02, 0, 3, 0));
  EXPECT_FALSE(is_reached(lift + 0.02, 0, 4, 0.7));
  EXPECT_TRUE(is_reached(lift - 0.01, 0, 3, 0));
  EXPECT_TRUE(is_reached(lift + 0.02, 0.1, 3, 0));  // a foot may pass under it
  EXPECT_TRUE(is_reached(lift + 0.02, 0, 1, 0));    // or beside it
}

TEST_F(FootholdFloodTest, GroundAboveOtherGroundIsReachedFromItsMiddle) {
  UnevenWorld world;
  world.Ground(-3, 5, 0).Ground(1, 2, 0.1, 1).Ground(1.4, 1.6, 0.35, 0.4);
  EXPECT_TRUE(IsReached(&world, UnevenWorld::StanceAt(1.2, 0.1)));
  EXPECT_FALSE(IsReached(&world, UnevenWorld::StanceAt(1.5, 0.1)));  // the upper block stands there
  EXPECT_FALSE(IsReached(&world, UnevenWorld::StanceAt(1.5, 0.35)));
}

TEST_F(FootholdFloodTest, CancellationEndsIt) {
  UnevenWorld world;
  world.Ground(-3, 5, 0);
  EXPECT_THROW(
      FloodOf(world.Built(), UnevenWorld::StanceAt(-1), CancellationToken([] { return false; })),
      Cancelled);
}

}  // namespace
}  // namespace possibility::actions
