#include "actions/motion/gradual_changes.h"

#include <gtest/gtest.h>

namespace possibility::actions {
namespace {

TEST(GradualChangesTest, AddUpEachFromRestToRest) {
  GradualChanges changes;
  EXPECT_TRUE(changes.empty());
  EXPECT_EQ(changes.At(3, 0.5).value, 0.5);
  changes.Add(1, 2, 0);
  EXPECT_TRUE(changes.empty());
  changes.Add(1, 2, 0.3);
  changes.Add(2, 4, -1);  // begins before the first one ends
  EXPECT_FALSE(changes.empty());
  EXPECT_EQ(changes.At(1).value, 0);
  EXPECT_NEAR(changes.At(2).value, 0.15, 1e-15);
  EXPECT_NEAR(changes.At(4, 0.5).value, 0.5 + 0.3 - 0.5, 1e-15);
  EXPECT_NEAR(changes.At(100).value, 0.3 - 1, 1e-15);
  EXPECT_EQ(changes.At(100).rate, 0);
  constexpr double kStep = 1e-5;
  for (double t = 0.5; t < 7; t += 0.1) {
    const auto before = changes.At(t - kStep);
    const auto after = changes.At(t + kStep);
    EXPECT_NEAR(changes.At(t).rate, (after.value - before.value) / (2 * kStep), 1e-8);
    EXPECT_NEAR(changes.At(t).acceleration, (after.rate - before.rate) / (2 * kStep), 1e-4);
  }
}

}  // namespace
}  // namespace possibility::actions
