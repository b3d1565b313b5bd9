#include "models/mesh/flat_regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/mesh/mesh_reader.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::RandomGeometry;

double PolygonArea(const std::vector<Vector3d>& polygon) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    twice += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return twice.norm() / 2;
}

double CoveredArea(const FlatRegion& region) {
  double area = 0;
  for (const auto& polygon : region.polygons) area += PolygonArea(polygon);
  return area;
}

/// Whether the vertical through p meets the polygon, seen from above.
bool IsAbove(const std::vector<Vector3d>& polygon, const Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d a = (polygon[(i + 1) % polygon.size()] - polygon[i]).head<2>();
    const Vector2d b = p - polygon[i].head<2>();
    if (a.x() * b.y() - a.y() * b.x() < 0) return false;
  }
  return true;
}

/// A polygon with straight sides over (x, y) cut into triangles at random: a square with random
/// points inside, each put into the triangle that holds it.
TriangleMesh CutSquare(RandomGeometry* random, int points, double side) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i < points; ++i) {
    const int t = random->Index(static_cast<int>(mesh.triangles.size()));
    const auto [a, b, c] = mesh.triangles[t];
    double u = random->Uniform(0.2, 0.4), v = random->Uniform(0.2, 0.4);
    const auto p = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) +
                            v * (mesh.vertices[c] - mesh.vertices[a]));
    mesh.triangles[t] = {a, b, p};
    mesh.triangles.push_back({b, c, p});
    mesh.triangles.push_back({c, a, p});
  }
  return mesh;
}

TEST(FlatRegions, ACubeHasSixSquares) {
  const std::vector<FlatRegion> regions = FlatRegions(testing::BoxMesh({1, 1, 1}));
  ASSERT_EQ(regions.size(), 6u);
  int level = 0;
  Vector3d sum = Vector3d::Zero();
  for (const FlatRegion& region : regions) {
    ASSERT_EQ(region.polygons.size(), 1u);
    EXPECT_EQ(region.polygons[0].size(), 4u);
    EXPECT_NEAR(region.area, 1, 1e-12);
    EXPECT_NEAR(CoveredArea(region), 1, 1e-12);
    sum += region.normal;
    if (!region.IsLevelEnough()) continue;
    ++level;
    EXPECT_EQ(region.normal, Vector3d::UnitZ());
    for (const Vector3d& corner : region.polygons[0]) EXPECT_EQ(corner.z(), 1);
    EXPECT_TRUE(IsAbove(region.polygons[0], {0.01, 0.99}));
  }
  EXPECT_EQ(level, 1);
  EXPECT_LT(sum.norm(), 1e-12);
}

TEST(FlatRegions, AnLWithAHoleIsFoundAgain) {
  // The top of an L-shaped slab with a square hole, on a grid of 0.25 m.
  TriangleMesh mesh;
  const auto is_ground = [](int x, int y) { return !(x >= 4 && y >= 3) && !(x == 1 && y == 1); };
  for (int y = 0; y <= 6; ++y) {
    for (int x = 0; x <= 8; ++x) mesh.vertices.emplace_back(0.25 * x, 0.25 * y, 0.4);
  }
  int cells = 0;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      if (!is_ground(x, y)) continue;
      ++cells;
      const int a = 9 * y + x;
      mesh.triangles.push_back({a, a + 1, a + 10});
      mesh.triangles.push_back({a, a + 10, a + 9});
    }
  }
  const std::vector<FlatRegion> regions = FlatRegions(mesh);
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_LE(regions[0].polygons.size(), 7u);
  EXPECT_NEAR(CoveredArea(regions[0]), 0.0625 * cells, 1e-12);
  RandomGeometry random(1);
  for (int i = 0; i < 5000; ++i) {
    const Vector2d p(random.Uniform(0, 2), random.Uniform(0, 1.5));
    int count = 0;
    for (const auto& polygon : regions[0].polygons) count += IsAbove(polygon, p);
    EXPECT_EQ(count, is_ground(static_cast<int>(4 * p.x()), static_cast<int>(4 * p.y())) ? 1 : 0);
  }
}

TEST(FlatRegions, RandomPlanesCutAtRandomAreOneRegionEach) {
  RandomGeometry random(2);
  for (int round = 0; round < 60; ++round) {
    const double tilt = random.Uniform(0, 1.2);
    const Eigen::Isometry3d X(
        Eigen::Translation3d(random.Uniform(-9, 9), random.Uniform(-9, 9), random.Uniform(0, 1)) *
        Eigen::AngleAxisd(random.Uniform(-3, 3), Vector3d::UnitZ()) *
        Eigen::AngleAxisd(tilt, Vector3d::UnitX()));
    const double side = random.Uniform(0.2, 3);
    TriangleMesh mesh = CutSquare(&random, 5, side).Placed(1, X);
    // Files hold single precision.
    for (Vector3d& vertex : mesh.vertices) vertex = vertex.cast<float>().cast<double>();
    const std::vector<FlatRegion> regions = FlatRegions(mesh);
    ASSERT_EQ(regions.size(), 1u) << round;
    const FlatRegion& region = regions[0];
    EXPECT_NEAR(region.area, side * side, 1e-5 * side);
    EXPECT_NEAR(CoveredArea(region), side * side, 1e-4 * side);
    EXPECT_EQ(region.IsLevelEnough(), tilt <= kSteepestBearing);
    EXPECT_LT((region.normal - X.linear().col(2)).norm(), 1e-4);
    for (const auto& polygon : region.polygons) {
      for (const Vector3d& corner : polygon) {
        EXPECT_NEAR(region.normal.dot(corner), region.normal.dot(region.polygons[0][0]), 1e-12);
        EXPECT_LT(std::abs((X.inverse() * corner).z()), 1e-5);
      }
    }
    for (int i = 0; i < 200; ++i) {
      const double u = random.Uniform(-0.2, 1.2), v = random.Uniform(-0.2, 1.2);
      const double depth = side * std::min({u, v, 1 - u, 1 - v});
      if (std::abs(depth) < 1e-4) continue;
      const Vector2d p = (X * Vector3d(u * side, v * side, 0)).head<2>();
      const auto count = std::count_if(region.polygons.begin(), region.polygons.end(),
                                       [&](const auto& polygon) { return IsAbove(polygon, p); });
      // Steep ones are not cut as seen from above.
      if (region.IsLevelEnough()) {
        EXPECT_EQ(count >= 1, depth > 0);
      }
    }
  }
}

TEST(FlatRegions, UnevennessWithinAMillimetreIsFlatMoreIsNot) {
  RandomGeometry random(3);
  for (const double height : {0.0004, 0.02}) {
    TriangleMesh mesh;
    for (int y = 0; y <= 10; ++y) {
      for (int x = 0; x <= 10; ++x) {
        mesh.vertices.emplace_back(0.1 * x, 0.1 * y, random.Uniform(-height, height) / 2);
      }
    }
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 10; ++x) {
        const int a = 11 * y + x;
        mesh.triangles.push_back({a, a + 1, a + 12});
        mesh.triangles.push_back({a, a + 12, a + 11});
      }
    }
    const std::vector<FlatRegion> regions = FlatRegions(mesh);
    if (height < kFlatness) {
      ASSERT_EQ(regions.size(), 1u);
      EXPECT_NEAR(CoveredArea(regions[0]), 1, 1e-4);
    } else {
      EXPECT_GT(regions.size(), 50u);
    }
    double area = 0;
    for (const FlatRegion& region : regions) {
      for (const auto& polygon : region.polygons) {
        for (const Vector3d& corner : polygon) {
          const auto nearest = std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                                                [&](const auto& a, const auto& b) {
                                                  return (a - corner).norm() < (b - corner).norm();
                                                });
          EXPECT_LT(std::abs(region.normal.dot(*nearest - corner)), kFlatness);
          EXPECT_LT((*nearest - corner).head<2>().norm(), 1e-9);
        }
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
          const Vector2d a = (polygon[i] - polygon[0]).head<2>();
          const Vector2d b = (polygon[i + 1] - polygon[0]).head<2>();
          area += (a.x() * b.y() - a.y() * b.x()) / 2;
        }
      }
    }
    EXPECT_NEAR(area, 1, 1e-5);  // of the footprint: no part of the ground is lost
  }
}

TEST(FlatRegions, AStaircaseHasItsTreadsAndRisers) {
  TriangleMesh mesh;
  for (int step = 0; step < 4; ++step) {
    testing::Append(testing::BoxMesh({0.3, 1, 0.15 * (step + 1)})
                        .Placed(1, Eigen::Isometry3d(Eigen::Translation3d(0.3 * step, 0, 0))),
                    &mesh);
  }
  std::vector<double> treads;
  for (const FlatRegion& region : FlatRegions(mesh)) {
    if (region.IsLevelEnough()) treads.push_back(region.polygons.at(0).at(0).z());
  }
  std::sort(treads.begin(), treads.end());
  ASSERT_EQ(treads.size(), 4u);
  for (int step = 0; step < 4; ++step) EXPECT_NEAR(treads[step], 0.15 * (step + 1), 1e-12);
}

}  // namespace
}  // namespace possibility::models
