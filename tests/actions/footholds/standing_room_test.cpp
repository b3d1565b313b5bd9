#include "actions/footholds/standing_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "actions/footholds/foothold_ground.h"
#include "actions/footholds/step_ground.h"
#include "tests/actions/footsteps/random_terrain.h"
#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

class StandingRoomTest : public ::testing::Test {
 protected:
  StepGround GroundOf(const World& world) const {
    return StepGround(WalkingHubo(), 0, world, limits_);
  }

  const NominalStance& stance_ = WalkingHubo().gaits[0]->stance;
  FootstepLimits limits_ = FootstepLimits::Of(DrcHubo1(), stance_);
};

/// A bridge 0.3 m wide has room for one foot ahead of the other, but not for both beside each
/// other unless one stands askew.
TEST_F(StandingRoomTest, OnANarrowBridgeOneStandsAskew) {
  UnevenWorld bridge, floor;
  const StepGround narrow = GroundOf(bridge.Ground(-3, 4, 0, 0.3).Built());
  EXPECT_FALSE(narrow.room->IsAt(0, {0, 0, 0}));
  EXPECT_FALSE(narrow.room->IsAt(0, {0, 0, std::numbers::pi}));
  EXPECT_TRUE(narrow.room->IsAt(0, {0, 0, std::numbers::pi / 4}));
  const StepGround broad = GroundOf(floor.Ground(-3, 4, 0).Built());
  EXPECT_TRUE(broad.room->IsAt(0, {0, 0, 0}));
}

/// Two planks, each with room for one foot, at two heights.
TEST_F(StandingRoomTest, EachFootMayHaveALevelOfItsOwn) {
  const double side = stance_.patch_centres[0].y();
  for (const double drop : {0.1, 0.4}) {
    UnevenWorld world;
    world.Add({3, 0.3, 0.5}, {0, side + 0.07, -0.25}, true);
    world.Add({3, 0.3, 0.5}, {0, -side - 0.07, -drop - 0.25}, true);
    const StepGround ground = GroundOf(world.Built());
    const bool reaches = drop <= limits_.rise;
    EXPECT_EQ(ground.room->IsAt(0, {0, 0, 0}), reaches) << drop;
    EXPECT_EQ(ground.room->IsAt(1, {0, 0, 0}), reaches) << drop;
  }
}

/// Where both soles of the nominal stance fit, with half a cell to spare, there is room.
TEST_F(StandingRoomTest, NominalStancesOnRandomTerrainHaveRoom) {
  int stands = 0, none = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    RandomTerrain terrain(seed);
    const World& world = terrain.world().Built();
    const StepGround ground = GroundOf(world);
    const FootholdGround footholds(DrcHubo1(), stance_, world, limits_.margin + 0.06);
    std::mt19937 random(seed);
    for (int i = 0; i < 300; ++i) {
      const int layer = static_cast<int>(random() % footholds.planes().size());
      const double turn = std::numbers::pi / StandingRoom::kHeadings;
      const PlanarPose middle{std::uniform_real_distribution(-1.5, 3.5)(random),
                              std::uniform_real_distribution(-0.5, 0.5)(random),
                              turn * static_cast<double>(random() % 16)};
      const int plane = footholds.planes()[layer];
      const bool fits = std::all_of(
          stance_.bearing_points.begin(), stance_.bearing_points.end(), [&](const auto& sole) {
            return std::all_of(sole.begin(), sole.end(), [&](const Eigen::Vector2d& p) {
              return world.ground->Clearance(plane, middle * p) >= limits_.margin + 0.06;
            });
          });
      if (fits) {
        ++stands;
        EXPECT_TRUE(ground.room->IsAt(layer, middle)) << seed << ": " << middle.x << " " << middle.y;
      } else if (!ground.room->IsAt(layer, middle)) {
        ++none;
      }
    }
  }
  EXPECT_GT(stands, 100);
  EXPECT_GT(none, 100);
}

TEST_F(StandingRoomTest, ThreadsThatShareItFindTheSame) {
  RandomTerrain terrain(3);
  const World& world = terrain.world().Built();
  const StepGround shared = GroundOf(world), alone = GroundOf(world);
  std::vector<std::vector<bool>> found(4);
  const auto ask = [](const StepGround& ground, std::vector<bool>* answers) {
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
      const PlanarPose middle{std::uniform_real_distribution(-2.0, 4.0)(random),
                              std::uniform_real_distribution(-0.8, 0.8)(random),
                              std::uniform_real_distribution(-3.0, 3.0)(random)};
      answers->push_back(
          ground.room->IsAt(static_cast<int>(random() % ground.cells->NumPlanes()), middle));
    }
  };
  std::vector<std::thread> threads;
  for (auto& answers : found) threads.emplace_back(ask, std::cref(shared), &answers);
  for (std::thread& thread : threads) thread.join();
  std::vector<bool> expected;
  ask(alone, &expected);
  for (const auto& answers : found) EXPECT_EQ(answers, expected);
}

}  // namespace
}  // namespace possibility::actions
