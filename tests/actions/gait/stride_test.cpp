#include "actions/gait/stride.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

class Strides : public ::testing::TestWithParam<StrideClass> {
 protected:
  /// A displacement in the directions of the class, shorter or longer than one stride.
  PlanarPose RandomDisplacement() {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto random = [&] { return unit(generator_); };
    switch (GetParam()) {
      case StrideClass::kStraight:
        return {random(), 0, 0};
      case StrideClass::kSideways:
        return {0, random(), 0};
      case StrideClass::kOblique:
        return {random(), random(), 0};
      case StrideClass::kTurn:
        return {0, 0, 3 * random()};
      default:
        return {random(), random(), 3 * random()};
    }
  }

  std::mt19937 generator_{2};
};

TEST_P(Strides, AllStridesOfAWayBelongToItsClassAndSumUpToIt) {
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const models::Gait& gait : DrcHubo1().gaits) {
    for (int trial = 0; trial < 200; ++trial) {
      const PlanarPose from{5 * unit(generator_), 5 * unit(generator_), 3 * unit(generator_)};
      const PlanarPose to = from * RandomDisplacement();
      EXPECT_EQ(ClassOfStrides(from, to), GetParam());
      EXPECT_EQ(ClassOfStrides(to, from), GetParam());
      const std::vector<PlanarPose> stances = PlanStrides(gait.parameters, from, to);
      ASSERT_EQ(static_cast<int>(stances.size()), StrideCount(gait.parameters, from, to) + 1);
      for (size_t i = 0; i + 1 < stances.size(); ++i) {
        const PlanarPose stride = stances[i].Inverse() * stances[i + 1];
        EXPECT_TRUE(Includes(GetParam(), stride));
        EXPECT_LE(StrideEffort(gait.parameters, stride), 1 + 1e-6);
      }
      EXPECT_LT((stances.back().position() - to.position()).norm(), 1e-12);
    }
  }
}

/// The least number that the bounds allow. It is known where all strides are the same.
TEST_P(Strides, AreNoMoreThanNeeded) {
  for (const models::Gait& gait : DrcHubo1().gaits) {
    for (int trial = 0; trial < 100; ++trial) {
      const PlanarPose whole = RandomDisplacement();
      if (KeepsHeading(GetParam()) || GetParam() == StrideClass::kTurn) {
        const double effort = StrideEffort(gait.parameters, whole);
        EXPECT_EQ(StrideCount(gait.parameters, {}, whole), std::ceil(effort - 1e-6));
      }
    }
  }
}

TEST_P(Strides, StandingStillBelongsToEveryClass) {
  EXPECT_TRUE(Includes(GetParam(), {}));
  EXPECT_EQ(StrideCount(DrcHubo1().gaits[0].parameters, {1, 2, 3}, {1, 2, 3}), 0);
}

INSTANTIATE_TEST_SUITE_P(Classes, Strides, ::testing::ValuesIn(kStrideClasses));

}  // namespace
}  // namespace possibility::actions
