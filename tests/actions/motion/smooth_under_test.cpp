#include "actions/motion/smooth_under.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr double kSampling = 0.02;

/// Jumps between random levels, after a rest at `rest`.
VectorXd RandomBound(std::mt19937* generator, double rest) {
  std::uniform_real_distribution<double> level(rest, rest + 0.3);
  std::uniform_int_distribution<int> length(5, 30);
  std::vector<double> samples(40, rest);
  while (samples.size() < 200) {
    samples.insert(samples.end(), length(*generator), level(*generator));
  }
  samples.insert(samples.end(), 40, rest);
  return Eigen::Map<VectorXd>(samples.data(), static_cast<Eigen::Index>(samples.size()));
}

/// From 0 on, at random distances up to kSampling.
VectorXd RandomTimes(std::mt19937* generator, Eigen::Index count) {
  std::uniform_real_distribution<double> step(0.2 * kSampling, kSampling);
  VectorXd times(count);
  times[0] = 0;
  for (Eigen::Index i = 1; i < count; ++i) times[i] = times[i - 1] + step(*generator);
  return times;
}

VectorXd EqualTimes(Eigen::Index count) {
  return VectorXd::LinSpaced(count, 0, kSampling * static_cast<double>(count - 1));
}

TEST(SmoothUnderTest, LiesNowhereAboveTheBound) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 100; ++trial) {
    const VectorXd bound = RandomBound(&generator, 0.7);
    const VectorXd times = RandomTimes(&generator, bound.size());
    const SmoothUnder curve(times, bound, 0.12);
    for (Eigen::Index i = 0; i < bound.size(); ++i) {
      EXPECT_LE(curve.At(times[i]).value, bound[i] + 1e-12);
    }
  }
}

TEST(SmoothUnderTest, RestsAtTheEndsWhereTheBoundIsLeast) {
  std::mt19937 generator(2);
  for (int trial = 0; trial < 100; ++trial) {
    const VectorXd bound = RandomBound(&generator, 0.7);
    const SmoothUnder curve(EqualTimes(bound.size()), bound, 0.12);
    for (const double t : {0.0, kSampling * static_cast<double>(bound.size() - 1)}) {
      EXPECT_NEAR(curve.At(t).value, 0.7, 1e-12);
      EXPECT_NEAR(curve.At(t).rate, 0, 1e-10);
      EXPECT_NEAR(curve.At(t).acceleration, 0, 1e-9);
    }
  }
}

TEST(SmoothUnderTest, DerivativesAreThoseOfTheValue) {
  std::mt19937 generator(3);
  const VectorXd bound = RandomBound(&generator, 0.7);
  const SmoothUnder curve(EqualTimes(bound.size()), bound, 0.12);
  constexpr double kSmall = 1e-5;
  const double end = kSampling * static_cast<double>(bound.size() - 1);
  for (double t = 0.0137; t < end - 0.01; t += 0.0231) {
    const ScalarSignal before = curve.At(t - kSmall);
    const ScalarSignal after = curve.At(t + kSmall);
    EXPECT_NEAR(curve.At(t).rate, (after.value - before.value) / (2 * kSmall), 1e-6);
    EXPECT_NEAR(curve.At(t).acceleration, (after.rate - before.rate) / (2 * kSmall), 1e-2);
  }
}

TEST(SmoothUnderTest, OfAConstantIsThatConstant) {
  const SmoothUnder curve(EqualTimes(50), VectorXd::Constant(50, 0.4), 0.1);
  for (const double t : {-1.0, 0.0, 0.33, 0.98, 5.0}) EXPECT_NEAR(curve.At(t).value, 0.4, 1e-14);
}

}  // namespace
}  // namespace possibility::actions
