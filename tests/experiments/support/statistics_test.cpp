#include "experiments/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace possibility::experiments {
namespace {

std::vector<double> OneTo(int n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1);
  std::shuffle(values.begin(), values.end(), std::mt19937(n));
  return values;
}

TEST(Statistics, OfOneToNAgreeWithClosedForms) {
  for (int n = 2; n < 60; ++n) {
    const SampleSummary summary = Summarise(OneTo(n));
    EXPECT_NEAR(summary.mean, (n + 1) / 2.0, 1e-12);
    EXPECT_NEAR(summary.std, std::sqrt(n * (n + 1) / 12.0), 1e-12);
    EXPECT_EQ(summary.median, (n + 1) / 2.0);
    EXPECT_EQ(summary.p95, std::ceil(0.95 * n - 1e-9)) << n;
    EXPECT_EQ(summary.max, n);
  }
}

TEST(Statistics, OfOneValueAreThatValue) {
  const SampleSummary summary = Summarise({-3.5});
  EXPECT_EQ(summary.mean, -3.5);
  EXPECT_EQ(summary.std, 0);
  EXPECT_EQ(summary.median, -3.5);
  EXPECT_EQ(summary.p95, -3.5);
  EXPECT_EQ(summary.max, -3.5);
}

TEST(Statistics, PercentilesAreTheSmallestThatCoverTheirShare) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<double> values(1 + round % 37);
    for (double& v : values) v = value(random);
    for (const double percent : {0.5, 5.0, 50.0, 90.0, 95.0, 100.0}) {
      const double found = Percentile(values, percent);
      const auto covered = [&](double limit) {
        return 100.0 *
               static_cast<double>(std::count_if(values.begin(), values.end(),
                                                 [&](double v) { return v <= limit; })) /
               static_cast<double>(values.size());
      };
      EXPECT_GE(covered(found), percent - 1e-6);
      EXPECT_LT(covered(std::nextafter(found, -2)), percent);
    }
  }
}

TEST(Statistics, RefuseEmptySamplesAndInvalidArguments) {
  EXPECT_THROW(Mean({}), std::invalid_argument);
  EXPECT_THROW(SampleStd({}), std::invalid_argument);
  EXPECT_THROW(Median({}), std::invalid_argument);
  EXPECT_THROW(Percentile({}, 95), std::invalid_argument);
  EXPECT_THROW(Percentile({1}, 0), std::invalid_argument);
  EXPECT_THROW(Percentile({1}, 101), std::invalid_argument);
  EXPECT_THROW(BootstrapMedianInterval({}), std::invalid_argument);
  EXPECT_THROW(WilsonInterval(2, 1), std::invalid_argument);
  EXPECT_THROW(WilsonInterval(-1, 1), std::invalid_argument);
}

// The interval's ends are the probabilities p whose score (p_hat - p) / sqrt(p (1 - p) / n) is the
// normal quantile.
TEST(Statistics, WilsonIntervalEndsSolveTheirEquation) {
  constexpr double kZ = 1.959963984540054;
  for (int n = 1; n < 40; ++n) {
    for (int k = 0; k <= n; ++k) {
      const auto [low, high] = WilsonInterval(k, n);
      const double p = static_cast<double>(k) / n;
      EXPECT_LE(low, p);
      EXPECT_GE(high, p);
      if (k > 0) {
        EXPECT_NEAR((p - low) / std::sqrt(low * (1 - low) / n), kZ, 1e-9);
      } else {
        EXPECT_EQ(low, 0);
      }
      if (k < n) {
        EXPECT_NEAR((high - p) / std::sqrt(high * (1 - high) / n), kZ, 1e-9);
      } else {
        EXPECT_EQ(high, 1);
      }
    }
  }
  EXPECT_EQ(WilsonInterval(0, 0), std::make_pair(0.0, 1.0));
}

// Order statistics of the median: for n = 25 the 95 % interval lies between the 8th and the 18th
// value (binomial 0.957). The bootstrap's interval must be near it.
TEST(Statistics, BootstrapIntervalOfTheMedianIsNearThatOfOrderStatistics) {
  std::vector<double> values = OneTo(25);
  const auto [low, high] = BootstrapMedianInterval(values);
  EXPECT_NEAR(low, 8, 1.01);
  EXPECT_NEAR(high, 18, 1.01);
  std::reverse(values.begin(), values.end());
  EXPECT_EQ(BootstrapMedianInterval(values), std::make_pair(low, high));
  EXPECT_EQ(BootstrapMedianInterval({2, 2, 2}), std::make_pair(2.0, 2.0));
}

}  // namespace
}  // namespace possibility::experiments
