#include "actions/flood/launch_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/actions/drchubo1.h"
#include "tests/actions/gap.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

bool Stands(const models::GroundMap& ground, int gait, const PlanarPose& pose) {
  return GroundMayHold(DrcHubo1Locomotion(), ground, gait, pose, 0, 0, 0);
}

/// If any launch of a box stands and lands, the box must say so, however often it is halved.
TEST(LaunchBox, ABoxThatHoldsALandingIsNeverRefused) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  int landed = 0, refused = 0;
  for (int scene = 0; scene < 300; ++scene) {
    models::Environment environment;
    for (int i = 0; i < 4; ++i) {
      environment.obstacles.push_back(Floor(1.5 * unit(generator), unit(generator),
                                            1.1 + 0.6 * unit(generator),
                                            1.1 + 0.6 * unit(generator), 3 * unit(generator)));
    }
    const models::GroundMap ground(environment);
    LaunchBox box{.launch = {0, 0}, .landing = {1, 0}};
    box.middle = {unit(generator), unit(generator), 3 * unit(generator)};
    box.half_place = {0.1 * (1 + unit(generator)), 0.1 * (1 + unit(generator))};
    box.half_heading = 0.1 * (1 + unit(generator));
    box.displacement = {0.6 + 0.4 * unit(generator), 0.3 * unit(generator), 0.3 * unit(generator)};
    box.half_displacement = {0.1 * (1 + unit(generator)), 0.1 * (1 + unit(generator))};
    box.half_turn = 0.1 * (1 + unit(generator));
    bool lands = false;
    for (int sample = 0; sample < 300 && !lands; ++sample) {
      const auto within = [&](double middle, double half) {
        return middle + half * unit(generator);
      };
      const PlanarPose launch{within(box.middle.x, box.half_place.x()),
                              within(box.middle.y, box.half_place.y()),
                              within(box.middle.yaw, box.half_heading)};
      const PlanarPose displacement{within(box.displacement.x, box.half_displacement.x()),
                                    within(box.displacement.y, box.half_displacement.y()),
                                    within(box.displacement.yaw, box.half_turn)};
      lands = Stands(ground, 0, launch) && Stands(ground, 1, launch * displacement);
    }
    bool before = true;
    for (const int halvings : {0, 3, 8, 14}) {
      const bool may_land = MayLand(DrcHubo1Locomotion(), ground, box, halvings);
      EXPECT_TRUE(may_land || !lands) << "scene " << scene << ", " << halvings << " halvings";
      EXPECT_TRUE(before || !may_land) << "halving loosened scene " << scene;
      before = may_land;
    }
    landed += lands;
    refused += !before;
  }
  EXPECT_GT(landed, 10);
  EXPECT_GT(refused, 50);
}

/// The only ground lies under the points of one launch at a corner of the box, and of its landing.
TEST(LaunchBox, TheOnlyLaunchThatStandsAndLandsIsFound) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int scene = 0; scene < 300; ++scene) {
    LaunchBox box{.launch = {0, 0}, .landing = {1, 0}};
    box.middle = {unit(generator), unit(generator), 3 * unit(generator)};
    box.displacement = {0.8 + 0.4 * unit(generator), 0.3 * unit(generator), 0.3 * unit(generator)};
    // The box is wide along one dimension and narrow along the others.
    double widths[6] = {0.002, 0.002, 0.002, 0.002, 0.002, 0.002};
    widths[scene % 6] = 0.2;
    box.half_place = {widths[0], widths[1]};
    box.half_heading = widths[2];
    box.half_displacement = {widths[3], widths[4]};
    box.half_turn = widths[5];
    const auto corner = [&](double middle, double half) {
      return middle + std::copysign(half, unit(generator));
    };
    const PlanarPose launch{corner(box.middle.x, widths[0]), corner(box.middle.y, widths[1]),
                            corner(box.middle.yaw, widths[2])};
    const PlanarPose displacement{corner(box.displacement.x, widths[3]),
                                  corner(box.displacement.y, widths[4]),
                                  corner(box.displacement.yaw, widths[5])};
    const PlanarPose ends[] = {launch, launch * displacement};
    models::Environment environment;
    for (const int gait : {0, 1}) {
      for (const auto& points : DrcHubo1Locomotion().gaits[gait]->stance.bearing_points) {
        for (const Vector2d& p_S : points) {
          const Vector2d p = ends[gait] * p_S;
          environment.obstacles.push_back(Floor(p.x(), p.y(), 0.001, 0.001, 0));
        }
      }
    }
    const models::GroundMap ground(environment);
    for (const int halvings : {0, 3, 8, 16}) {
      EXPECT_TRUE(MayLand(DrcHubo1Locomotion(), ground, box, halvings))
          << "scene " << scene << ", " << halvings << " halvings";
    }
  }
}

TEST(LaunchBox, HalvedBoxesRefuseAGapBeyondReach) {
  const LaunchBox box{.launch = {0, 0},
                      .landing = {1, 0},
                      .middle = {-0.2, 0, 0},
                      .half_place = {0.4, 0.05},
                      .half_heading = 0.01,
                      .displacement = {0.9, 0, 0},
                      .half_displacement = {0.1, 0}};
  const double widest = WidestGap(1);
  const auto may_land = [&](double gap, int halvings) {
    return MayLand(DrcHubo1Locomotion(), models::GroundMap(Gap(gap)), box, halvings);
  };
  EXPECT_TRUE(may_land(widest - 0.01, 16));
  EXPECT_TRUE(may_land(widest + 0.06, 0));
  EXPECT_FALSE(may_land(widest + 0.06, 16));
}

}  // namespace
}  // namespace possibility::actions
