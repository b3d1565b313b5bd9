#include "experiments/imports/differences.h"

#include <gtest/gtest.h>

#include <cmath>

namespace possibility::experiments {
namespace {

TEST(DifferenceWeightsTest, AreExactForPolynomials) {
  const std::vector<double> times = {0.3, 0.41, 0.5, 0.63, 0.7, 0.9, 1.0};
  for (const double t : {0.3, 0.63, 1.0}) {
    const DifferenceWeights weights = WeightsAt(t, times);
    for (int power = 0; power <= 6; ++power) {
      Eigen::VectorXd x(7);
      for (int i = 0; i < 7; ++i) x[i] = std::pow(times[i], power);
      EXPECT_NEAR(weights.first.dot(x), power == 0 ? 0 : power * std::pow(t, power - 1), 1e-9);
      EXPECT_NEAR(weights.second.dot(x),
                  power < 2 ? 0 : power * (power - 1) * std::pow(t, power - 2), 1e-7);
    }
  }
}

TEST(DifferenceWeightsTest, AreTheTextbookOnesOnAGrid) {
  const DifferenceWeights weights = WeightsAt(2, {1, 2, 3});
  EXPECT_LT((weights.first - Eigen::Vector3d(-0.5, 0, 0.5)).norm(), 1e-15);
  EXPECT_LT((weights.second - Eigen::Vector3d(1, -2, 1)).norm(), 1e-15);
}

TEST(DifferenceWeightsTest, TwoSamplesGiveTheirSlope) {
  const DifferenceWeights weights = WeightsAt(0, {0, 0.5});
  EXPECT_LT((weights.first - Eigen::Vector2d(-2, 2)).norm(), 1e-15);
  EXPECT_EQ(weights.second, Eigen::VectorXd::Zero(2));
}

}  // namespace
}  // namespace possibility::experiments
