#include "graph/structure/nearest_vertices.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <vector>

#include "graph/action/random.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph {
namespace {

using test::MakePoint;

/// The closest of the vertices that `admits` accepts, by measuring all distances.
std::optional<VertexId> ClosestByMeasuring(const std::vector<Point>& points, const Point& target,
                                           const NearestVertices::Filter& admits) {
  std::optional<VertexId> closest;
  for (VertexId v = 0; v < static_cast<int>(points.size()); ++v) {
    if (admits(v) &&
        (!closest || (points[v] - target).norm() < (points[*closest] - target).norm())) {
      closest = v;
    }
  }
  return closest;
}

TEST(NearestVertices, ClosestIsTheLeastOfAllDistances) {
  RandomGenerator generator(3);
  const test::Room room;
  for (const double spread : {1e-6, 1.0, 1e5}) {
    NearestVertices nearest(&room);
    std::vector<Point> points;
    EXPECT_EQ(nearest.Closest(MakePoint(0, 0)), std::nullopt);
    for (int i = 0; i < 700; ++i) {
      // Every seventh point repeats an existing one.
      points.push_back(i % 7 == 6 ? points[i / 2] : Point(spread * room.RandomSample(&generator)));
      nearest.Insert(i, points.back());
      const Point target = spread * room.RandomSample(&generator);
      const auto everyone = [](VertexId) { return true; };
      const auto some = [&](VertexId v) { return v % 5 == i % 5 && v < 300; };
      EXPECT_EQ(nearest.Closest(target), ClosestByMeasuring(points, target, everyone));
      EXPECT_EQ(nearest.Closest(target, some), ClosestByMeasuring(points, target, some));
      EXPECT_EQ(nearest.Closest(points[i]), ClosestByMeasuring(points, points[i], everyone));
    }
  }
}

}  // namespace
}  // namespace possibility::graph
