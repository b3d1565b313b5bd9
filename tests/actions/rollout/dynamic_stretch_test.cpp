#include "actions/rollout/dynamic_stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

class DynamicStretchTest : public ::testing::Test {
 protected:
  /// The plan with one segment per phase.
  static Plan CutIntoPhases(const Plan& plan) {
    Plan cut = plan;
    cut.segments.clear();
    for (const Segment& segment : plan.segments) {
      for (const Phase& phase : segment.phases) cut.segments.push_back({segment.action, {phase}});
    }
    return cut;
  }

  /// The walk, and its reverse in time: from its end at rest back to its beginning.
  static Plan ThereAndBack(const Plan& plan) {
    Plan both = plan;
    Segment back = plan.segments.front();
    std::reverse(back.phases.begin(), back.phases.end());
    double t = plan.segments.back().phases.back().knots.back().t;
    for (Phase& phase : back.phases) {
      const double end = phase.knots.back().t;
      std::reverse(phase.knots.begin(), phase.knots.end());
      for (Knot& knot : phase.knots) {
        knot.t = t + end - knot.t;
        knot.v = -knot.v;
      }
      t = phase.knots.back().t;
    }
    both.segments.push_back(back);
    return both;
  }

  models::Scenario scenario_ = testing::FlatScenario();
  Plan walk_ = WalkTo({0.5, 0, 0}, scenario_);
};

TEST_F(DynamicStretchTest, AWalkFromRestToRestIsOneStretchHoweverItIsCut) {
  const std::size_t phases = walk_.segments.front().phases.size();
  ASSERT_GT(phases, 3u);
  for (const Plan& plan : {walk_, CutIntoPhases(walk_)}) {
    const std::vector<DynamicStretch> stretches = DynamicStretches(plan);
    ASSERT_EQ(stretches.size(), 1u);
    EXPECT_EQ(stretches.front().motion.phases.size(), phases);
    EXPECT_EQ(stretches.front().first_segment, 0);
    EXPECT_EQ(stretches.front().last_segment, static_cast<int>(plan.segments.size()) - 1);
  }
}

TEST_F(DynamicStretchTest, WalksWithRestBetweenAreStretchesOfTheirOwn) {
  const std::vector<DynamicStretch> stretches = DynamicStretches(ThereAndBack(walk_));
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_EQ(stretches[0].last_segment, 0);
  EXPECT_EQ(stretches[1].first_segment, 1);
}

TEST_F(DynamicStretchTest, StandingIsNotSimulated) {
  Plan plan = walk_;
  Phase standing = plan.segments.front().phases.front();
  standing.knots.resize(1);
  Knot end = standing.knots.front();
  end.t += 1;
  standing.knots.push_back(end);
  plan.segments = {{"walk", {standing}}};
  EXPECT_TRUE(DynamicStretches(plan).empty());
}

}  // namespace
}  // namespace possibility::actions
