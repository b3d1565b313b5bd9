#include "graph/structure/vertex_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "graph/action/random.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph {
namespace {

using test::MakePoint;

TEST(VertexIndex, FindsExactlyThePointsCloserThanTheTolerance) {
  RandomGenerator generator(5);
  const test::Room room;
  VertexIndex index(&room, MakePoint(0.5, 0.5));
  std::vector<Point> points;
  for (int i = 0; i < 500; ++i) {
    points.push_back(room.RandomSample(&generator));
    index.Insert(i, points.back());
  }
  for (int i = 0; i < 500; ++i) {
    const double angle = UniformReal(0, 6.28, &generator);
    const Point direction = MakePoint(std::cos(angle), std::sin(angle));
    EXPECT_EQ(index.Find(points[i]), i);
    EXPECT_EQ(index.Find(points[i] + 0.9e-9 * direction), i);
    EXPECT_EQ(index.Find(points[i] + 1.1e-9 * direction), std::nullopt);
  }
}

}  // namespace
}  // namespace possibility::graph
