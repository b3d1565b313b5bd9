#include "actions/motion/swing_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

std::vector<SwingPath> SomeSwings() {
  return {{{0, 0.1, 0}, {0.3, 0.1, 0}, 0.05, 0, 0.5},
          {{0, 0, 0}, {0.4, 0.1, 0}, 0.05, 0.2, 1},
          {{0, 0, 0}, {0.25, 0, 0.15}, 0.03, 0, 1.2},
          {{0, 0, 0.2}, {0.3, 0, 0}, 0.03, 0.02, 0.9},
          {{1, 2, 0.3}, {0.7, 2, 0.3}, 0.04, 0.1, 0.7},
          {{0, 0.1, 0}, {0.8, 0.1, 0}, 0.05, 0, 0.4, false, 6},
          {{1, 2, 0.3}, {1.3, 2.1, 0.37}, 0.04, 0, 0.6, true},
          {{1, 2, 0.3}, {1.3, 2.1, 0.37}, 0.04, 0, 0.6, true, 3},
          {{1, 2, 0.3}, {1.3, 2.1, 0.37}, 0.04, 0.1, 0.6, true}};
}

double HigherEnd(const SwingPath& swing) { return std::max(swing.from.z(), swing.to.z()); }

TEST(SwingPathTest, LeadsFromRestToRest) {
  for (const SwingPath& swing : SomeSwings()) {
    const auto start = swing.At(0);
    const auto end = swing.At(swing.duration);
    EXPECT_LT((start.value - swing.from).norm(), 1e-14);
    EXPECT_LT((end.value - swing.to).norm(), 1e-14);
    for (const auto& rest : {start, end}) {
      EXPECT_LT(rest.rate.norm(), 1e-12);
      EXPECT_LT(rest.acceleration.norm(), 1e-11);
    }
  }
}

TEST(SwingPathTest, DerivativesAreThoseOfTheValue) {
  constexpr double kStep = 1e-5;
  for (const SwingPath& swing : SomeSwings()) {
    for (double t = 2 * kStep; t < swing.duration - 2 * kStep; t += swing.duration / 53) {
      const auto before = swing.At(t - kStep);
      const auto after = swing.At(t + kStep);
      EXPECT_LT((swing.At(t).rate - (after.value - before.value) / (2 * kStep)).norm(), 1e-7);
      EXPECT_LT((swing.At(t).acceleration - (after.rate - before.rate) / (2 * kStep)).norm(), 1e-2);
    }
  }
}

TEST(SwingPathTest, AHighSwingIsAboveBothEndsWhereverItIsFarFromThem) {
  for (const SwingPath& swing : SomeSwings()) {
    if (!swing.IsHigh()) continue;
    for (double t = 0; t < swing.duration; t += swing.duration / 1000) {
      const double across = swing.Progress(t).value;
      if (across < 0.06 || across > 0.94) continue;
      EXPECT_GT(swing.At(t).value.z(), HigherEnd(swing) + 0.3 * swing.clearance)
          << across << " of the way";
    }
  }
}

TEST(SwingPathTest, OnASlopeTheSwingFollowsTheLineBetweenItsEnds) {
  const SwingPath swing{{1, 2, 0.3}, {1.3, 2.1, 0.37}, 0.04, 0, 0.6, true};
  EXPECT_FALSE(swing.IsHigh());
  double highest = 0;
  for (double t = 0; t <= swing.duration; t += swing.duration / 200) {
    const Vector3d p = swing.At(t).value;
    const double across =
        (p - swing.from).head<2>().norm() / (swing.to - swing.from).head<2>().norm();
    const double above = p.z() - (swing.from.z() + across * (swing.to.z() - swing.from.z()));
    EXPECT_GT(above, -1e-12);
    highest = std::max(highest, above);
  }
  EXPECT_NEAR(highest, swing.clearance, 1e-3);
}

TEST(SwingPathTest, ReachesItsLift) {
  for (const SwingPath& swing : SomeSwings()) {
    if (swing.on_slope && !swing.IsHigh()) continue;  // above the line between its ends
    const double top = swing.At(swing.duration / 2).value.z() - HigherEnd(swing);
    EXPECT_NEAR(top, std::max(swing.lift, swing.clearance), 1e-12);
  }
}

}  // namespace
}  // namespace possibility::actions
