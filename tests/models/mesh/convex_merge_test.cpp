#include "models/mesh/convex_merge.h"

#include <gtest/gtest.h>

#include <random>

namespace possibility::models {
namespace {

using Eigen::Vector2d;

/// Triangles of a grid of squares, of which some are left out.
struct Grid {
  std::vector<Vector2d> points;
  std::vector<std::array<int, 3>> triangles;

  template <typename Keep>
  Grid(int columns, int rows, std::mt19937* random, const Keep& keep) {
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x <= columns; ++x) points.emplace_back(0.1 * x, 0.1 * y);
    }
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        if (!keep(x, y)) continue;
        const int a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
        if ((*random)() % 2 == 0) {
          triangles.push_back({a, b, c});
          triangles.push_back({a, c, d});
        } else {
          triangles.push_back({a, b, d});
          triangles.push_back({b, c, d});
        }
      }
    }
    std::shuffle(triangles.begin(), triangles.end(), *random);
  }
};

bool IsConvex(const ConvexPolygon& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d a = polygon[(i + 1) % n] - polygon[i];
    const Vector2d b = polygon[(i + 2) % n] - polygon[(i + 1) % n];
    if (!(a.x() * b.y() - a.y() * b.x() > 0)) return false;
  }
  return n >= 3;
}

bool HoldsPoint(const ConvexPolygon& polygon, const Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d a = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vector2d b = p - polygon[i];
    if (a.x() * b.y() - a.y() * b.x() < 0) return false;
  }
  return true;
}

double AreaOfAll(const std::vector<ConvexPolygon>& polygons) {
  double area = 0;
  for (const ConvexPolygon& polygon : polygons) {
    EXPECT_TRUE(IsConvex(polygon));
    area += AreaOf(polygon);
  }
  return area;
}

TEST(ConvexMerge, ARectangleOfTrianglesIsOneRectangle) {
  std::mt19937 random(1);
  const Grid grid(30, 20, &random, [](int, int) { return true; });
  const auto polygons = MergedConvex(grid.points, grid.triangles);
  EXPECT_LE(polygons.size(), 8u);
  EXPECT_NEAR(AreaOfAll(polygons), 6, 1e-12);
}

TEST(ConvexMerge, AnLWithAHoleIsCoveredExactlyOnce) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const auto keep = [](int x, int y) {
      const bool corner = x >= 10 && y >= 8;
      const bool hole = x >= 3 && x < 6 && y >= 2 && y < 5;
      return !corner && !hole;
    };
    const Grid grid(20, 16, &random, keep);
    const auto polygons = MergedConvex(grid.points, grid.triangles);
    EXPECT_LE(polygons.size(), 24u);
    EXPECT_NEAR(AreaOfAll(polygons), 0.01 * static_cast<double>(grid.triangles.size()) / 2, 1e-9);
    std::uniform_real_distribution<> x(0, 2), y(0, 1.6);
    for (int i = 0; i < 2000; ++i) {
      const Vector2d p(x(random), y(random));
      int count = 0;
      for (const ConvexPolygon& polygon : polygons) count += HoldsPoint(polygon, p);
      const bool inside = keep(static_cast<int>(p.x() / 0.1), static_cast<int>(p.y() / 0.1));
      EXPECT_EQ(count, inside ? 1 : 0) << p.transpose();
    }
  }
}

TEST(ConvexMerge, ARoundHoleIsNotFilled) {
  // Short sides, each nearly in line with the next.
  constexpr int kSides = 2000;
  std::vector<Vector2d> points;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    points.emplace_back(std::cos(angle), std::sin(angle));
    points.emplace_back(2 * std::cos(angle), 2 * std::sin(angle));
    const int a = 2 * i, b = 2 * ((i + 1) % kSides);
    triangles.push_back({a, a + 1, b});
    triangles.push_back({b, a + 1, b + 1});
  }
  const auto polygons = MergedConvex(points, triangles);
  const double ring = kSides * std::sin(2 * M_PI / kSides) / 2 * 3;
  EXPECT_NEAR(AreaOfAll(polygons), ring, 0.02);
  EXPECT_LE(polygons.size(), 1000u);
  for (const ConvexPolygon& polygon : polygons) {
    EXPECT_FALSE(HoldsPoint(polygon, {0.9, 0}));
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d middle = (polygon[i] + polygon[(i + 1) % polygon.size()]) / 2;
      EXPECT_GT(middle.norm(), 1 - 2e-3);
    }
  }
}

TEST(ConvexMerge, HullsLeaveOutWhatLiesInside) {
  std::mt19937 random(3);
  std::normal_distribution<> any;
  for (int round = 0; round < 200; ++round) {
    std::vector<Vector2d> points(3 + random() % 30);
    for (Vector2d& p : points) p = {any(random), any(random)};
    const ConvexPolygon hull = HullOf(points, 0);
    EXPECT_TRUE(IsConvex(hull));
    for (const Vector2d& p : points) {
      const bool is_corner = std::find(hull.begin(), hull.end(), p) != hull.end();
      EXPECT_TRUE(is_corner || HoldsPoint(hull, p));
    }
  }
}

}  // namespace
}  // namespace possibility::models
