#include "models/shapes/bounds_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

AlignedBox3d RandomBounds(testing::RandomGeometry* random) {
  const Vector3d centre = random->Pose(4).translation();
  const Vector3d half = 0.5 * random->Pose(1).translation().cwiseAbs();
  return {centre - half, centre + half};
}

TEST(BoundsTree, VisitsExactlyTheItemsWithinTheLimit) {
  testing::RandomGeometry random(1);
  for (const int count : {0, 1, 2, 3, 17, 500}) {
    std::vector<AlignedBox3d> items;
    for (int i = 0; i < count; ++i) items.push_back(RandomBounds(&random));
    const BoundsTree tree(items);
    for (int trial = 0; trial < 200; ++trial) {
      const AlignedBox3d bounds = RandomBounds(&random);
      const double limit = trial % 2 == 0 ? 0 : random.Uniform(0, 3);
      std::vector<int> visited, expected;
      tree.VisitNear(bounds, limit, [&](int item) {
        visited.push_back(item);
        return limit;
      });
      for (int i = 0; i < count; ++i) {
        if (items[i].exteriorDistance(bounds) <= limit) expected.push_back(i);
      }
      std::sort(visited.begin(), visited.end());
      EXPECT_EQ(visited, expected);
    }
  }
}

TEST(BoundsTree, VeryLargeItemsAreVisitedLikeTheRest) {
  testing::RandomGeometry random(3);
  std::vector<AlignedBox3d> items;
  for (int i = 0; i < 300; ++i) items.push_back(RandomBounds(&random));
  for (int i = 0; i < 60; ++i) {  // one around the other, and some alike
    const Vector3d half = Vector3d::Constant(4 + i / 2);
    items.emplace_back(-half, half);
  }
  const BoundsTree tree(items);
  for (int trial = 0; trial < 200; ++trial) {
    const AlignedBox3d bounds = RandomBounds(&random);
    const double limit = random.Uniform(0, 1);
    std::vector<int> visited, expected;
    tree.VisitNear(bounds, limit, [&](int item) {
      visited.push_back(item);
      return limit;
    });
    for (size_t i = 0; i < items.size(); ++i) {
      if (items[i].exteriorDistance(bounds) <= limit) expected.push_back(static_cast<int>(i));
    }
    std::sort(visited.begin(), visited.end());
    EXPECT_EQ(visited, expected);
  }
}

TEST(BoundsTree, ShrinkingLimitFindsTheNearest) {
  testing::RandomGeometry random(2);
  std::vector<AlignedBox3d> items;
  for (int i = 0; i < 300; ++i) items.push_back(RandomBounds(&random));
  const BoundsTree tree(items);
  for (int trial = 0; trial < 200; ++trial) {
    const AlignedBox3d bounds = RandomBounds(&random);
    double nearest = 1e9;
    tree.VisitNear(bounds, nearest, [&](int item) {
      nearest = std::min(nearest, items[item].exteriorDistance(bounds));
      return nearest;
    });
    double expected = 1e9;
    for (const AlignedBox3d& item : items) {
      expected = std::min(expected, item.exteriorDistance(bounds));
    }
    EXPECT_DOUBLE_EQ(nearest, expected);
  }
}

TEST(BoundsTree, NegativeLimitEndsTheSearch) {
  const AlignedBox3d unit(Vector3d::Zero(), Vector3d::Ones());
  const BoundsTree tree(std::vector<AlignedBox3d>(1000, unit));
  int visits = 0;
  tree.VisitNear(unit, 0, [&](int) {
    ++visits;
    return -1.0;
  });
  EXPECT_EQ(visits, 1);
}

}  // namespace
}  // namespace possibility::models
