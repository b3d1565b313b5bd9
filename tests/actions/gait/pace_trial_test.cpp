#include "actions/gait/pace_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/actions/dynamic_gaits.h"

namespace possibility::actions {
namespace {

class PaceTrialTest : public ::testing::Test {
 protected:
  const FlowingGait& walk_ = DrcHubo1Flowing("walk");
  const PaceTrial trial_{DrcHubo1(), walk_.stance()};
  /// The quickest of the family.
  const Pace pace_ = walk_.motion().paces()[walk_.motion().paces().size() - 2];
};

/// The load is measured on a motion without limits, the answer comes from one that keeps them.
TEST_F(PaceTrialTest, StepsAreForbiddenIfTheyNeedMoreThanTheLimits) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> factor(0.8, 1.3);
  int allowed = 0, forbidden = 0;
  for (int i = 0; i < 60; ++i) {
    Pace pace = pace_;
    pace.bounds.forward *= factor(random);
    pace.timing.swing *= factor(random);
    pace.timing.swing_length = pace.bounds.forward;
    pace.rise *= factor(random);
    const PlanarPose step{pace.bounds.forward, 0, 0};
    const double load = trial_.Load(pace, step);
    const bool allows = trial_.Allows(pace, step);
    // Of the friction, the load asks for a reserve that the answer does without.
    if (load <= 1) {
      EXPECT_TRUE(allows) << trial_.WhyNot(pace, step, kFittedClearance);
    } else if (std::isfinite(load)) {
      EXPECT_FALSE(allows) << load;
    }
    ++(allows ? allowed : forbidden);
  }
  EXPECT_GT(allowed, 5);
  EXPECT_GT(forbidden, 5);
}

TEST_F(PaceTrialTest, LongerStepsInTheSameTimeNeedMore) {
  Pace pace = pace_;
  double before = 0;
  for (const double length : {0.1, 0.2, 0.3}) {
    pace.bounds.forward = pace.timing.swing_length = length;
    const double load = trial_.Load(pace, {length, 0, 0});
    EXPECT_GT(load, before) << length;
    before = load;
  }
}

TEST_F(PaceTrialTest, NamesWhatForbidsSteps) {
  Pace pace = pace_;
  pace.bounds.forward = pace.timing.swing_length = 0.34;
  EXPECT_NE(trial_.WhyNot(pace, {0.34, 0, 0}, kFittedClearance), "");
  EXPECT_EQ(trial_.WhyNot(pace_, {pace_.bounds.forward, 0, 0}, kFittedClearance), "");
}

}  // namespace
}  // namespace possibility::actions
