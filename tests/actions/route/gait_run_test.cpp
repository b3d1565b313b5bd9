#include "actions/route/gait_run.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

double ExpectedOf(const Route& route, int first, int count) {
  const auto begin = route.begin() + first;
  return ExpectedDuration(DrcHubo1Locomotion(), Route(begin, begin + count));
}

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

TEST(GaitRun, IsAsLongAsItsDurationAllows) {
  std::mt19937 generator(1);
  for (const std::string gait : {"walk", "crawl"}) {
    for (const double longest : {1.0, 5.0, 60.0}) {
      const Route route = RandomWays(gait, 60, longest, &generator);
      const int legs = static_cast<int>(route.size());
      int runs = 0;
      for (int first = 0; first < legs; ++runs) {
        const int count = RunLength(DrcHubo1Locomotion(), route, first);
        ASSERT_GE(count, 1);
        ASSERT_LE(first + count, legs);
        if (count > 1) {
          EXPECT_LE(ExpectedOf(route, first, count), kLongestRun);
        }
        if (first + count < legs) {
          EXPECT_GT(ExpectedOf(route, first, count + 1), kLongestRun);
        }
        first += count;
      }
      EXPECT_GT(runs, 1);
    }
  }
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
