#include "collocation/transcription/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace possibility::collocation {
namespace {

TEST(GaussLegendre, FivePointsHaveTheirClosedForm) {
  const std::vector<QuadraturePoint> rule = GaussLegendre(5);
  const double inner = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3;
  const double outer = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
  const double inner_weight = (322 + 13 * std::sqrt(70.0)) / 1800;
  const double outer_weight = (322 - 13 * std::sqrt(70.0)) / 1800;
  const std::vector<double> roots = {-outer, -inner, 0, inner, outer};
  const std::vector<double> weights = {outer_weight, inner_weight, 64.0 / 225, inner_weight,
                                       outer_weight};
  ASSERT_EQ(rule.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(rule[i].share, (1 + roots[i]) / 2, 1e-15) << i;
    EXPECT_NEAR(rule[i].weight, weights[i], 1e-15) << i;
  }
}

/// The integral of t^p over [0, 1] is 1 / (p + 1).
double ErrorOfPower(int points, int power) {
  double sum = 0;
  for (const QuadraturePoint& point : GaussLegendre(points)) {
    sum += point.weight * std::pow(point.share, power);
  }
  return std::abs(sum - 1.0 / (power + 1));
}

TEST(GaussLegendre, IsExactForTwiceAsManyPowersAsPointsAndNoMore) {
  for (int points = 1; points <= 8; ++points) {
    for (int power = 0; power < 2 * points; ++power) {
      EXPECT_LT(ErrorOfPower(points, power), 1e-14) << points << " points, power " << power;
    }
    EXPECT_GT(ErrorOfPower(points, 2 * points), 1e-11) << points << " points";
  }
}

}  // namespace
}  // namespace possibility::collocation
