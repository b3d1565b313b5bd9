#include "actions/gait/pace_search.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/gait/pace_trial.h"
#include "common/cancellation_token.h"
#include "tests/actions/dynamic_gaits.h"

namespace possibility::actions {
namespace {

class PaceSearchTest : public ::testing::Test {
 protected:
  std::optional<Pace> Search(const CancellationToken& cancellation = {}) const {
    PaceSearchSettings settings;
    settings.trials = 250;
    settings.seeds = {1};
    return SearchPace(DrcHubo1(), walk_.stance(), start_, settings, cancellation);
  }

  const FlowingGait& walk_ = DrcHubo1Flowing("walk");
  /// The quickest of the family.
  const Pace start_ = walk_.motion().paces()[walk_.motion().paces().size() - 2];
};

TEST_F(PaceSearchTest, FindsAQuickerPaceThatKeepsTheLimits) {
  const std::optional<Pace> found = Search();
  ASSERT_TRUE(found);
  EXPECT_GT(found->speed(), start_.speed());
  EXPECT_GE(found->bounds.lateral, start_.bounds.lateral);
  EXPECT_GE(found->bounds.turn, start_.bounds.turn);
  const PaceTrial trial(DrcHubo1(), walk_.stance());
  for (const PlanarPose& step :
       {PlanarPose{found->bounds.forward, 0, 0}, PlanarPose{0, found->bounds.lateral, 0},
        PlanarPose{0, 0, found->bounds.turn}}) {
    EXPECT_EQ(trial.WhyNot(*found, step, kFittedClearance), "");
  }
  const std::optional<Pace> again = Search();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->speed(), found->speed());
  EXPECT_EQ(again->style.turn, found->style.turn);
}

// With few steps, arms that became too fast on longer ways had gone unseen.
TEST(OptimisedCrawl, HoldsOnWaysOfAnyLength) {
  const DynamicGait& crawl = DrcHubo1Flowing("crawl").motion();
  ASSERT_EQ(crawl.paces().size(), 3u);
  const Pace& pace = crawl.paces().front();
  EXPECT_GT(pace.speed(), 1.5 * crawl.paces()[1].speed());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any_length(0.3, 9);
  for (int i = 0; i < 12; ++i) {
    const double length = any_length(random);
    EXPECT_NO_THROW(
        crawl.MotionAt(pace, {PlanarPose(), PlanarPose{length, 0, 0}}, crawl.Settings(), false))
        << length;
  }
}

// Volumes of the optimised crawl, whose trunk leans, do not contain those of an upright one.
TEST(OptimisedCrawl, DoesNotStandForPacesOfAnotherStyle) {
  const DynamicGait& crawl = DrcHubo1Flowing("crawl").motion();
  ASSERT_NE(crawl.paces()[0].style, crawl.paces()[1].style);
  const double stride = DrcHubo1Flowing("crawl").parameters().forward;
  const std::vector<std::vector<Phase>> variants =
      crawl.Variants({PlanarPose(), PlanarPose{stride, 0, 0}}, 0.04, {});
  EXPECT_EQ(variants.size(), 1 + crawl.paces().size());  // the quasi-static one, too
}

TEST_F(PaceSearchTest, CanBeCancelled) {
  EXPECT_THROW(Search(CancellationToken([] { return false; })), Cancelled);
}

}  // namespace
}  // namespace possibility::actions
