#include "actions/route/gait_run.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// Straight ways of one gait, end to end.
Route RandomWays(const std::string& gait, int legs, double longest, std::mt19937* generator) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Route route;
  PlanarPose place;
  for (int i = 0; i < legs; ++i) {
    RouteLeg leg;
    leg.gait = DrcHubo1Locomotion().GaitIndex(gait);
    leg.from = place;
    place = place * PlanarPose{longest * unit(*generator), 0, 0};
    if (i % 2 == 1) place = leg.from * PlanarPose{0, 0, 2 * unit(*generator)};
    leg.to = place;
    route.push_back(leg);
  }
  return route;
}

TEST(GaitRun, ReachesToTheEndOfTheRoute) {
  std::mt19937 generator(1);
  EXPECT_EQ(RunLength(DrcHubo1Locomotion(), RandomWays("crawl", 60, 5, &generator), 20), 40);
}

TEST(GaitRun, EndsWhereTheGaitOrTheHeightChanges) {
  std::mt19937 generator(2);
  Route route = RandomWays("walk", 6, 1, &generator);
  for (std::size_t i = 3; i < route.size(); ++i) route[i].z = route[i].z_to = 0.1;
  EXPECT_EQ(RunLength(DrcHubo1Locomotion(), route, 0), 3);
  route = RandomWays("walk", 6, 1, &generator);
  route[2].gait = DrcHubo1Locomotion().GaitIndex("crawl");
  EXPECT_EQ(RunLength(DrcHubo1Locomotion(), route, 0), 2);
}

}  // namespace
}  // namespace possibility::actions
