#include "actions/footsteps/step_refusals.h"

#include <gtest/gtest.h>

namespace possibility::actions {
namespace {

using Breadth = StepRefusals::Breadth;

/// Straight ahead, both feet level.
Footstep StepOf(double from, double to, double lift = 0) {
  Footstep step;
  step.from.stance = {from, 0.2, 0};
  step.to.stance = {to, 0.2, 0};
  step.lift = lift;
  return step;
}

class RefusalBreadthTest : public ::testing::Test {
 protected:
  bool Refuses(Breadth breadth, const Footstep& step) const {
    StepRefusals refusals(breadth);
    refusals.Add(StepOf(-0.3, 0.3, 0.06), other_);
    return refusals.Refuses(step, other_);
  }
  Foothold other_;
};

TEST_F(RefusalBreadthTest, WhatFailedIsRefused) {
  for (const Breadth breadth : {Breadth::kBeyond, Breadth::kSame}) {
    EXPECT_TRUE(Refuses(breadth, StepOf(-0.3, 0.3, 0.06)));
    EXPECT_TRUE(Refuses(breadth, StepOf(-0.301, 0.305, 0.065)));
  }
}

TEST_F(RefusalBreadthTest, WhatIsEasierInAnyRespectIsNot) {
  for (const Breadth breadth : {Breadth::kBeyond, Breadth::kSame}) {
    EXPECT_FALSE(Refuses(breadth, StepOf(-0.2, 0.4, 0.09)));
    EXPECT_FALSE(Refuses(breadth, StepOf(-0.4, 0.2, 0.09)));
    EXPECT_FALSE(Refuses(breadth, StepOf(-0.4, 0.4, 0)));
  }
}

TEST_F(RefusalBreadthTest, WhatIsHarderInEveryRespectIsRefusedIfRefusalsAreBroad) {
  EXPECT_TRUE(Refuses(Breadth::kBeyond, StepOf(-0.4, 0.4, 0.09)));
  EXPECT_FALSE(Refuses(Breadth::kSame, StepOf(-0.4, 0.4, 0.09)));
}

TEST_F(RefusalBreadthTest, APostureIsRefusedWhateverTheRestOfTheStep) {
  StepRefusals refusals(Breadth::kSame);
  refusals.AddEnd(StepOf(0, 0.3).to, other_);
  EXPECT_TRUE(refusals.Refuses(StepOf(-0.1, 0.3), other_));
  EXPECT_TRUE(refusals.Refuses(StepOf(0.3, 0), other_));
  EXPECT_FALSE(refusals.Refuses(StepOf(-0.1, 0.2), other_));
}

}  // namespace
}  // namespace possibility::actions
