#include "dynamics/ode/bracketed_root.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace possibility::dynamics {
namespace {

/// A cubic that rises or falls from `root`, where it is zero, with random other coefficients.
struct RisingCubic {
  double root, slope, curvature;
  double operator()(double x) const {
    const double d = x - root;
    return slope * d * (1 + curvature * d + curvature * curvature * d * d);
  }
};

TEST(BracketedRoot, LiesWithinTheResolutionBehindTheTrueRoot) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  int evaluations = 0;
  constexpr int kTrials = 2000;
  constexpr double kResolution = 1e-11;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double begin = unit(random), end = begin + std::pow(10, -4 * unit(random));
    const double root = begin + unit(random) * (end - begin);
    const RisingCubic cubic{root, (unit(random) < 0.5 ? -1 : 1) * std::pow(10, 6 * unit(random)),
                            2 * (unit(random) - 0.5) / (end - begin)};
    const double found = BracketedRoot({begin, cubic(begin)}, {end, cubic(end)}, kResolution,
                                       [&](double x) { return ++evaluations, cubic(x); });
    EXPECT_GE(found, root - 1e-15) << trial;
    EXPECT_LE(found, root + kResolution + 1e-15) << trial;
  }
  // Bisection would take 23 to 37 each.
  EXPECT_LT(evaluations, 9 * kTrials);
}

TEST(BracketedRoot, AStepIsFoundByBisection) {
  int evaluations = 0;
  const auto step = [&](double x) { return ++evaluations, x < 0.3 ? 1.0 : -1e6; };
  const double found = BracketedRoot({0, 1}, {1, -1e6}, 1e-9, step);
  EXPECT_GE(found, 0.3);
  EXPECT_LE(found, 0.3 + 1e-9);
  EXPECT_LE(evaluations, 60);
}

TEST(BracketedRoot, AnExactZeroIsReturned) {
  const auto line = [](double x) { return x - 0.5; };
  EXPECT_EQ(BracketedRoot({0, -0.5}, {1, 0.5}, 1e-12, line), 0.5);
  EXPECT_EQ(BracketedRoot({0.5, 0}, {1, 0.5}, 1e-12, line), 0.5);
  EXPECT_EQ(BracketedRoot({0, -0.5}, {0.5, 0}, 1e-12, line), 0.5);
}

TEST(BracketedRoot, TheFarEndOfAnIntervalBelowTheResolutionIsReturned) {
  const auto line = [](double x) { return x - 0.25; };
  EXPECT_EQ(BracketedRoot({0, -0.25}, {0.5, 0.25}, 0.5, line), 0.5);
}

}  // namespace
}  // namespace possibility::dynamics
