#include "actions/flood/cell_outline.h"

#include <gtest/gtest.h>

#include <random>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Outline = std::vector<Vector2i>;

int TwiceTheArea(const Outline& outline) {
  int area = 0;
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vector2i& a = outline[i];
    const Vector2i& b = outline[(i + 1) % outline.size()];
    area += a.x() * b.y() - b.x() * a.y();
  }
  return area;
}

/// Winding number of the outlines around a point that is on none of them.
int Winding(const std::vector<Outline>& outlines, const Vector2d& p) {
  int winding = 0;
  for (const Outline& outline : outlines) {
    for (size_t i = 0; i < outline.size(); ++i) {
      const Vector2i& a = outline[i];
      const Vector2i& b = outline[(i + 1) % outline.size()];
      if (a.x() != b.x() || a.x() < p.x()) continue;
      if (a.y() < p.y() && b.y() > p.y()) ++winding;
      if (a.y() > p.y() && b.y() < p.y()) --winding;
    }
  }
  return winding;
}

TEST(CellOutlineTest, ARingHasAnOuterOutlineAndAHole) {
  CellMask mask(5, 4);
  for (int x = 1; x < 4; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x != 2 || y != 1) mask.Add(x, y);
    }
  }
  const std::vector<Outline> outlines = mask.Outlines();
  ASSERT_EQ(outlines.size(), 2u);
  EXPECT_EQ(TwiceTheArea(outlines[0]), 18);
  EXPECT_EQ(outlines[0].size(), 4u) << "corners only";
  EXPECT_EQ(TwiceTheArea(outlines[1]), -2);
}

TEST(CellOutlineTest, CellsThatShareOnlyACornerHaveSeparateOutlines) {
  CellMask mask(2, 2);
  mask.Add(0, 0);
  mask.Add(1, 1);
  EXPECT_EQ(mask.Outlines().size(), 2u);
  EXPECT_TRUE(CellMask(3, 3).Outlines().empty());
}

TEST(CellOutlineTest, OutlinesGoOnceAroundEveryCellOfARandomMask) {
  std::mt19937 generator(2);
  for (int trial = 0; trial < 200; ++trial) {
    const int nx = 1 + static_cast<int>(generator() % 12);
    const int ny = 1 + static_cast<int>(generator() % 12);
    CellMask mask(nx, ny);
    int count = 0;
    for (int x = 0; x < nx; ++x) {
      for (int y = 0; y < ny; ++y) {
        if (generator() % 5 < 3) {
          mask.Add(x, y);
          ++count;
        }
      }
    }
    const std::vector<Outline> outlines = mask.Outlines();
    int area = 0;
    for (const Outline& outline : outlines) {
      area += TwiceTheArea(outline);
      for (size_t i = 0; i < outline.size(); ++i) {
        const Vector2i a = outline[(i + 1) % outline.size()] - outline[i];
        const Vector2i b = outline[(i + 2) % outline.size()] - outline[(i + 1) % outline.size()];
        EXPECT_EQ(a.dot(b), 0) << "corners only";
      }
    }
    EXPECT_EQ(area, 2 * count);
    for (int x = 0; x < nx; ++x) {
      for (int y = 0; y < ny; ++y) {
        EXPECT_EQ(Winding(outlines, {x + 0.5, y + 0.5}), mask.Contains(x, y));
      }
    }
  }
}

}  // namespace
}  // namespace possibility::actions
