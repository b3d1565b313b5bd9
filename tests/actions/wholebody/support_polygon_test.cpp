#include "actions/wholebody/support_polygon.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

std::vector<Vector2d> RandomPoints(std::mt19937* generator, int count) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Vector2d> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(coordinate(*generator), coordinate(*generator));
  return points;
}

/// Margin by brute force: the least distance, over all directions, of the hull's extent beyond the
/// point.
double MarginByDirections(const std::vector<Vector2d>& points, const Vector2d& p) {
  double margin = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 20000; ++i) {
    const double angle = 2 * EIGEN_PI * i / 20000;
    const Vector2d direction(std::cos(angle), std::sin(angle));
    double extent = -std::numeric_limits<double>::infinity();
    for (const Vector2d& q : points) extent = std::max(extent, direction.dot(q - p));
    margin = std::min(margin, extent);
  }
  return margin;
}

TEST(SupportPolygonTest, MarginAgreesWithExtentsInAllDirections) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 30; ++trial) {
    const std::vector<Vector2d> points = RandomPoints(&generator, 3 + trial % 8);
    const SupportPolygon polygon(points);
    for (const Vector2d& p : RandomPoints(&generator, 5)) {
      EXPECT_NEAR(polygon.Margin(p), MarginByDirections(points, p), 2e-4);
    }
  }
}

TEST(SupportPolygonTest, NearestKeepsTheMarginAndNoGridPointIsCloser) {
  std::mt19937 generator(2);
  for (int trial = 0; trial < 30; ++trial) {
    const SupportPolygon polygon(RandomPoints(&generator, 6));
    const double margin = 0.1;
    for (const Vector2d& preferred : RandomPoints(&generator, 4)) {
      const Vector2d nearest = polygon.Nearest(preferred, margin);
      double largest = -1;
      double closest = std::numeric_limits<double>::infinity();
      for (double x = -1; x <= 1; x += 0.02) {
        for (double y = -1; y <= 1; y += 0.02) {
          const double m = polygon.Margin({x, y});
          largest = std::max(largest, m);
          if (m >= margin) closest = std::min(closest, (Vector2d(x, y) - preferred).norm());
        }
      }
      if (largest < margin) {
        EXPECT_GE(polygon.Margin(nearest), largest - 0.002);
      } else {
        EXPECT_GE(polygon.Margin(nearest), margin - 1e-9);
        EXPECT_LE((nearest - preferred).norm(), closest + 1e-9);
      }
    }
  }
}

TEST(SupportPolygonTest, DegenerateSupportsGiveTheirNearestPointAndMargin) {
  EXPECT_EQ(SupportPolygon({Vector2d(1, 2)}).Nearest({0, 0}, 0.1), Vector2d(1, 2));
  const SupportPolygon segment({Vector2d(0, 0), Vector2d(1, 0)});
  EXPECT_LT((segment.Nearest({0.5, 1}, 0.1) - Vector2d(0.5, 0)).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(segment.Margin({0.5, 1}), -1);
}

}  // namespace
}  // namespace possibility::actions
