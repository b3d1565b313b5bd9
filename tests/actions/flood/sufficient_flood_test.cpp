#include "actions/flood/sufficient_flood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "actions/flood/route_flood.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/gap.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Two rooms and a corridor between them, 1 m long.
models::Environment Corridor(double width) {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Vector2d(-2.5, -1.5), Vector2d(2.5, 1.5));
  environment.obstacles = {Floor(0, 0, 6, 4, 0)};
  for (const int side : {-1, 1}) {
    models::Obstacle block;
    block.shape = models::Shape::Box({1, 2, 2});
    block.X_WO = PlanarPose{0, side * (1 + width / 2), 0}.At(1);
    environment.obstacles.push_back(block);
  }
  return environment;
}

/// The narrowest width that the walker fits through, over all headings.
double NarrowestStance() {
  double narrowest = std::numeric_limits<double>::infinity();
  for (double yaw = 0; yaw < std::numbers::pi; yaw += 0.001) {
    double least = 0, most = 0;
    for (const Eigen::AlignedBox3d& box : DrcHubo1Locomotion().gaits[0]->volumes.standing) {
      for (const double x : {box.min().x(), box.max().x()}) {
        for (const double y : {box.min().y(), box.max().y()}) {
          const double across = std::sin(yaw) * x + std::cos(yaw) * y;
          least = std::min(least, across);
          most = std::max(most, across);
        }
      }
    }
    narrowest = std::min(narrowest, most - least);
  }
  return narrowest;
}

bool MayPass(double width, int halvings) {
  static const LocomotionModel walking = DrcHubo1Walking();
  const models::Environment environment = Corridor(width);
  const models::GroundMap ground(environment);
  return FloodSufficient(walking, {&environment, &ground}, {0, {-1.8, 0, 0}, 0},
                         {{0, {1.8, 0, 0}, 0}}, {.halvings = halvings})
      .route_may_exist;
}

TEST(SufficientFlood, HalvedCellsRuleOutACorridorTooNarrow) {
  const double narrowest = NarrowestStance();
  EXPECT_TRUE(MayPass(narrowest + 0.01, 0));
  EXPECT_TRUE(MayPass(narrowest + 0.01, 3));
  EXPECT_TRUE(MayPass(narrowest - 0.1, 0));
  EXPECT_FALSE(MayPass(narrowest - 0.1, 3));
}

/// The answer is sharper than whole cells of launch and landing would allow.
TEST(SufficientFlood, AGapBeyondTheFarthestLandingIsRuledOut) {
  static constexpr double kFarthest = 1.1;
  const auto may_cross = [&](double gap) {
    const models::Environment environment = Gap(gap);
    const models::GroundMap ground(environment);
    const FloodManoeuvre leap{
        0, 1, [](double rise) {
          return rise == 0 ? std::optional(LandingRange{{Vector2d::Zero(), Vector2d(kFarthest, 0)}})
                           : std::nullopt;
        }};
    return FloodSufficient(DrcHubo1Locomotion(), {&environment, &ground}, {0, {-1, 0, 0}, 0},
                           {{1, {gap + 1, 0, 0}, 0}}, {}, {}, {leap})
        .route_may_exist;
  };
  EXPECT_TRUE(may_cross(WidestGap(kFarthest) - 0.01));
  EXPECT_FALSE(may_cross(WidestGap(kFarthest) + 0.1));
}

}  // namespace
}  // namespace possibility::actions
