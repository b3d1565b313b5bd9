// Steps along straight ways: all limbs meet in every bend, and only what fails gives way.

#include "actions/gait/stepped_way.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "actions/gait/stride.h"
#include "actions/wholebody/motion_error.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

class SteppedWayTest : public ::testing::Test {
 protected:
  /// Strides along ways through `corners`.
  std::vector<PlanarPose> Strides(const std::vector<PlanarPose>& corners) const {
    std::vector<PlanarPose> strides = {corners.front()};
    for (std::size_t i = 1; i < corners.size(); ++i) {
      const auto more = PlanStrides(walk_.gait.parameters, corners[i - 1], corners[i]);
      strides.insert(strides.end(), more.begin() + 1, more.end());
    }
    return strides;
  }

  SteppedWay WayThrough(const std::vector<PlanarPose>& corners) const {
    return {walk_.stance, groups_, StraightLines(Strides(corners)), bounds_};
  }

  const LocomotionModel::GaitEntry& walk_ = *DrcHubo1Locomotion().gaits[0];
  std::vector<std::vector<int>> groups_ = SwingGroups(walk_.stance);
  StepBounds bounds_ = {0.3, 0.3, 0.5};
};

double Distance(const PlanarPose& a, const PlanarPose& b) {
  return (a.position() - b.position()).norm() + std::abs(WrapAngle(a.yaw - b.yaw));
}

/// The number of steps after which all groups stand in `corner`; -1: they never do.
int StepsUntilAllAreIn(const PlanarPose& corner, const std::vector<Step>& steps) {
  std::map<int, PlanarPose> places;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    places[steps[i].group] = steps[i].stance;
    if (places.size() == 2 && Distance(places[0], corner) < 1e-9 &&
        Distance(places[1], corner) < 1e-9) {
      return static_cast<int>(i) + 1;
    }
  }
  return -1;
}

TEST_F(SteppedWayTest, AllLimbsMeetInEveryBend) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 15; ++i) {
    std::vector<PlanarPose> corners = {{unit(generator), unit(generator), unit(generator)}};
    for (int k = 0; k < 4; ++k) {
      corners.push_back(corners.back() * PlanarPose{unit(generator), k % 2 == 0 ? 0 : 0.4, 0});
      corners.push_back(corners.back() * PlanarPose{0, 0, 0.2 + unit(generator)});
    }
    const std::vector<Step> steps = WayThrough(corners).Steps();
    for (std::size_t k = 1; k < corners.size(); ++k) {
      EXPECT_GT(StepsUntilAllAreIn(corners[k], steps), 0) << "way " << i << ", corner " << k;
    }
    EXPECT_EQ(StepsUntilAllAreIn(corners.back(), steps), static_cast<int>(steps.size()));
  }
}

TEST_F(SteppedWayTest, StepsBecomeShorterOnTheWayOfTheIntervalOnly) {
  const PlanarPose corner{0, 1.2, 0};
  SteppedWay way = WayThrough({{}, corner, corner * PlanarPose{0, 0, 2}});
  const std::vector<Step> before = way.Steps();
  const int aside = StepsUntilAllAreIn(corner, before);
  const int turning = static_cast<int>(before.size()) - aside;
  // Intervals of a schedule: a rest, then a swing and a double support for each step.
  const int first_of_turn = 1 + 2 * aside;
  ASSERT_TRUE(way.Shorten({first_of_turn}));
  const std::vector<Step> after = way.Steps();
  ASSERT_EQ(StepsUntilAllAreIn(corner, after), aside);
  for (int i = 0; i < aside; ++i) {
    EXPECT_EQ(after[i].group, before[i].group);
    EXPECT_EQ(Distance(after[i].stance, before[i].stance), 0) << i;
  }
  EXPECT_GT(static_cast<int>(after.size()) - aside, turning);
  // At most to half the length.
  while (way.Shorten({first_of_turn})) {
  }
  EXPECT_LE(static_cast<int>(way.Steps().size()) - aside, 2 * turning + 2);
  EXPECT_TRUE(way.Shorten({1, first_of_turn}));
}

TEST_F(SteppedWayTest, StepsStraightAheadDoNotBecomeShorter) {
  SteppedWay way = WayThrough({{}, {2, 0, 0}});
  const std::size_t steps = way.Steps().size();
  EXPECT_FALSE(way.Shorten({3}));
  EXPECT_FALSE(way.Shorten({-1}));
  EXPECT_EQ(way.Steps().size(), steps);
}

TEST_F(SteppedWayTest, AStepItsLikesAndTheirNeighboursAreSlowedDownToHalfTheSpeed) {
  const PlanarPose corner{1.5, 0, 0};
  SteppedWay way = WayThrough({{}, corner, corner * PlanarPose{0, 0, 2}});
  const int ahead = StepsUntilAllAreIn(corner, way.Steps());
  EXPECT_FALSE(way.SlowDown(-1));
  // A step of the turn: the ways ahead, but for the step before the bend, are unlike it.
  const int interval = 1 + 2 * (ahead + 2);
  ASSERT_TRUE(way.SlowDown(interval));
  for (int i = 0; i < ahead - 1; ++i) EXPECT_EQ(way.Steps()[i].slowness, 1) << i;
  EXPECT_GT(way.Steps()[ahead + 2].slowness, 1);
  while (way.SlowDown(interval)) {
  }
  EXPECT_GT(way.Steps()[ahead + 2].slowness, 1.5);
  for (const Step& step : way.Steps()) EXPECT_LE(step.slowness, 2);
}

TEST_F(SteppedWayTest, AStepInABendIsUnlikeTheSameStepElsewhere) {
  const PlanarPose corner{3, 0, 0};
  SteppedWay way = WayThrough({{}, corner, corner * PlanarPose{0, 0, 2}});
  const int ahead = StepsUntilAllAreIn(corner, way.Steps());
  ASSERT_GT(ahead, 8);
  // The last full step ahead: what follows it differs from what follows the others.
  int last_full = ahead - 1;
  const auto length = [&](int i) {
    return (way.Steps()[i].stance.position() - way.Steps()[i - 2].stance.position()).norm();
  };
  while (length(last_full) < 0.5) --last_full;
  ASSERT_TRUE(way.SlowDown(1 + 2 * last_full));
  EXPECT_GT(way.Steps()[last_full].slowness, 1);
  for (int i = 0; i < last_full - 1; ++i) EXPECT_EQ(way.Steps()[i].slowness, 1) << i;
  // One in the middle of the way is like all others there.
  ASSERT_TRUE(way.SlowDown(1 + 2 * 4));
  for (int i = 3; i < last_full - 1; ++i) EXPECT_GT(way.Steps()[i].slowness, 1) << i;
}

TEST_F(SteppedWayTest, StepsBecomeShorterNearTheIntervalOfALineThatBends) {
  const auto lines = RoundedLines({{}, {4, 0, 0}, {4, 0, 1.5}, {4, 4, 1.5}}, {1, 1});
  SteppedWay way(walk_.stance, groups_, lines, bounds_);
  const std::vector<Step> before = way.Steps();
  int bend = 0;
  while (before[bend].stance.yaw < 0.7) ++bend;
  ASSERT_TRUE(way.Shorten({1 + 2 * bend}));
  const std::vector<Step> after = way.Steps();
  EXPECT_GT(after.size(), before.size());
  for (int i = 0; i < 8; ++i) EXPECT_EQ(after[i].group, before[i].group) << i;
  // Far from it steps are about as long as before.
  const auto length = [](const std::vector<Step>& steps, std::size_t i) {
    return (steps[i].stance.position() - steps[i - 1].stance.position()).norm();
  };
  EXPECT_NEAR(length(after, 4), length(before, 4), 0.05);
}

TEST_F(SteppedWayTest, AWayToNowhereHasNoFootholds) { EXPECT_THROW(WayThrough({{}}), MotionError); }

}  // namespace
}  // namespace possibility::actions
