#include "actions/rollout/perturbed_rollouts.h"

#include <gtest/gtest.h>

#include <numbers>

#include "actions/rollout/perturbed_rollout.h"
#include "actions/rollout/rollout_check.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

/// A walk of half a metre on a flat floor.
class PerturbedRolloutsTest : public ::testing::Test {
 protected:
  RolloutDrift Drift(const Perturbation& perturbation) const {
    const auto rollouts = RollOutPerturbed(plan_, DrcHubo1(), scenario_, {perturbation});
    EXPECT_EQ(rollouts.size(), 1u);
    EXPECT_EQ(rollouts.front().stretches.size(), 1u);
    EXPECT_EQ(rollouts.front().survives(), rollouts.front().stretches.front().drift.survives());
    return rollouts.front().stretches.front().drift;
  }

  models::Scenario scenario_ = testing::FlatScenario();
  Plan plan_ = WalkTo({0.5, 0, 0}, scenario_);
};

TEST_F(PerturbedRolloutsTest, WithoutPerturbationTheResultIsCloseToTheVerifiers) {
  const RolloutDrift drift = Drift({});
  const models::GroundMap ground(scenario_.environment);
  const RolloutDrift verified = RollOutSegment(plan_.segments.front(), DrcHubo1(), ground);
  EXPECT_NEAR(drift.worst_position, verified.worst_position, 3e-3);
  EXPECT_NEAR(drift.end_position, verified.end_position, 3e-3);
  EXPECT_TRUE(drift.survives());
  EXPECT_GT(drift.torque_used, 0.1);
  EXPECT_LT(drift.slide, 3e-3);
}

TEST_F(PerturbedRolloutsTest, WhatIsNotMeasuredLeavesTheRestAsItIs) {
  const models::GroundMap ground(scenario_.environment);
  const Segment& segment = plan_.segments.front();
  RolloutCheckSettings check;
  const RolloutDrift whole = RollOutSegment(segment, DrcHubo1(), ground, check);
  check.measures_torque = false;
  const RolloutDrift part = RollOutSegment(segment, DrcHubo1(), ground, check);
  EXPECT_GT(whole.torque_used, 0.1);
  EXPECT_EQ(part.torque_used, 0);
  EXPECT_EQ(part.worst_position, whole.worst_position);
  EXPECT_EQ(part.end_position, whole.end_position);
  EXPECT_EQ(part.impacts, whole.impacts);

  Perturbation hard;
  hard.push = 100;
  for (const Perturbation& perturbation : {Perturbation(), hard}) {
    PerturbedRolloutSettings settings;
    const RolloutDrift compared =
        RollOutPerturbed(segment, DrcHubo1(), ground, perturbation, settings);
    settings.compares = false;
    const RolloutDrift bare = RollOutPerturbed(segment, DrcHubo1(), ground, perturbation, settings);
    EXPECT_EQ(bare.survives(), compared.survives());
    EXPECT_EQ(bare.fell_at, compared.fell_at);
    EXPECT_EQ(bare.end_position, compared.end_position);
    EXPECT_EQ(bare.slide, 0);
    EXPECT_GT(compared.worst_joint, 0);
  }
}

TEST_F(PerturbedRolloutsTest, JointErrorsGrowInProportionToAddedMass) {
  const double error = Drift({}).worst_joint;
  Perturbation heavy;
  heavy.mass = 1.02;
  const double little = Drift(heavy).worst_joint - error;
  heavy.mass = 1.04;
  const double more = Drift(heavy).worst_joint - error;
  EXPECT_GT(little, 0);
  EXPECT_NEAR(more / little, 2, 0.5);
}

TEST_F(PerturbedRolloutsTest, TheRobotFallsOnASteepSlopeToTheSideThatIsLower) {
  Perturbation slope;
  slope.side_slope = 20 * std::numbers::pi / 180;
  EXPECT_FALSE(Drift(slope).survives());
}

TEST_F(PerturbedRolloutsTest, TheRobotFallsAfterAHardPush) {
  Perturbation push;
  push.push = 100;
  push.push_direction = std::numbers::pi / 2;
  const RolloutDrift drift = Drift(push);
  ASSERT_TRUE(drift.fell_at);
  EXPECT_GT(*drift.fell_at, (drift.start + drift.end) / 2);
}

TEST_F(PerturbedRolloutsTest, WeakMotorsLetTheRobotFall) {
  Perturbation weak;
  weak.torque = 0.3;
  EXPECT_FALSE(Drift(weak).survives());
}

TEST_F(PerturbedRolloutsTest, FeetSlideOnIce) {
  Perturbation ice;
  ice.friction = 0.05;
  const RolloutDrift drift = Drift(ice);
  EXPECT_TRUE(drift.fell_at || drift.slide > 0.02);
}

TEST_F(PerturbedRolloutsTest, ResultsDoNotDependOnThreads) {
  Perturbation heavy;
  heavy.mass = 1.05;
  const std::vector<Perturbation> cases = {{}, heavy};
  PerturbedRolloutsSettings settings;
  settings.threads = 2;
  const auto parallel = RollOutPerturbed(plan_, DrcHubo1(), scenario_, cases, settings);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(parallel[i].stretches.front().drift.worst_position, Drift(cases[i]).worst_position);
  }
}

TEST_F(PerturbedRolloutsTest, CancellingThrows) {
  PerturbedRolloutsSettings settings;
  settings.cancellation = CancellationToken([] { return false; });
  EXPECT_THROW(RollOutPerturbed(plan_, DrcHubo1(), scenario_, {{}}, settings), Cancelled);
}

}  // namespace
}  // namespace possibility::actions
