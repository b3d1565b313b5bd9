// The flood over blocks of cells, compared with a flood that looks at every cell.

#include "actions/flood/cell_quadtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <queue>
#include <random>
#include <vector>

#include "actions/flood/block_flood.h"

namespace possibility::actions {
namespace {

/// Cells that are open or closed at random, in patches of all sizes, and the links between them.
struct Maze {
  struct Link {
    CellBlock from;
    CellBlock to;
  };
  int planes;
  int nx;
  int ny;
  std::vector<char> open;
  std::vector<Link> links;
  std::vector<Link> late;  ///< taken up by cells with an even x only

  Maze(std::mt19937* generator)
      : planes(1 + static_cast<int>((*generator)() % 3)),
        nx(1 + static_cast<int>((*generator)() % 40)),
        ny(1 + static_cast<int>((*generator)() % 40)),
        open(static_cast<size_t>(planes) * nx * ny, 1) {
    for (int i = 0; i < 60; ++i) {
      const CellBlock block = RandomBlock(generator, i < 10 ? 16 : 3);
      for (int x = block.x0; x < block.x1; ++x) {
        for (int y = block.y0; y < block.y1; ++y) At(block.plane, x, y) = i % 3 == 2;
      }
    }
    for (int i = 0; i < 5; ++i) {
      links.push_back({RandomBlock(generator, 4), RandomBlock(generator, 4)});
      late.push_back({RandomBlock(generator, 4), RandomBlock(generator, 4)});
    }
  }

  CellBlock RandomBlock(std::mt19937* generator, int most) const {
    const auto below = [&](int n) { return static_cast<int>((*generator)() % n); };
    CellBlock block = CellBlock::Of(below(planes), below(nx), below(ny));
    block.x1 = std::min(nx, block.x0 + 1 + below(most));
    block.y1 = std::min(ny, block.y0 + 1 + below(most));
    return block;
  }

  char& At(int plane, int x, int y) { return open[(static_cast<size_t>(plane) * nx + x) * ny + y]; }
  bool Contains(const CellBlock& cell) const {
    return cell.plane >= 0 && cell.plane < planes && cell.x0 >= 0 && cell.x0 < nx && cell.y0 >= 0 &&
           cell.y0 < ny;
  }

  BlockState Judge(const CellBlock& block) {
    int num_open = 0;
    for (int x = block.x0; x < block.x1; ++x) {
      for (int y = block.y0; y < block.y1; ++y) num_open += At(block.plane, x, y);
    }
    if (num_open == 0) return BlockState::kClosed;
    const int num_cells = (block.x1 - block.x0) * (block.y1 - block.y0);
    return num_open == num_cells ? BlockState::kOpen : BlockState::kMixed;
  }
};

bool Overlap(const CellBlock& a, const CellBlock& b) {
  return a.plane == b.plane && a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

/// The reference: every cell by itself.
std::vector<char> FloodCellByCell(Maze* maze, const CellBlock& seed) {
  std::vector<char> reached(maze->open.size(), 0);
  const auto at = [&](const CellBlock& cell) -> char& {
    return reached[(static_cast<size_t>(cell.plane) * maze->nx + cell.x0) * maze->ny + cell.y0];
  };
  std::queue<CellBlock> queue;
  const auto enter = [&](const CellBlock& cell, bool is_seed = false) {
    if (!maze->Contains(cell) || at(cell)) return;
    if (!is_seed && !maze->At(cell.plane, cell.x0, cell.y0)) return;
    at(cell) = 1;
    queue.push(cell);
  };
  const auto enter_all = [&](const CellBlock& block) {
    for (int x = block.x0; x < block.x1; ++x) {
      for (int y = block.y0; y < block.y1; ++y) enter(CellBlock::Of(block.plane, x, y));
    }
  };
  enter(seed, true);
  while (!queue.empty()) {
    const CellBlock cell = queue.front();
    queue.pop();
    for (const int step : {-1, 1}) {
      enter(CellBlock::Of(cell.plane, cell.x0 + step, cell.y0));
      enter(CellBlock::Of(cell.plane, cell.x0, cell.y0 + step));
    }
    for (const Maze::Link& link : maze->links) {
      if (Overlap(link.from, cell)) enter_all(link.to);
    }
    for (const Maze::Link& link : maze->late) {
      if (Overlap(link.from, cell) && cell.x0 % 2 == 0) enter_all(link.to);
    }
  }
  return reached;
}

std::vector<char> SparseFlood(Maze* maze, const CellBlock& seed) {
  BlockFlood flood(maze->planes, maze->nx, maze->ny,
                   [&](const CellBlock& block) { return maze->Judge(block); }, {});
  EXPECT_EQ(flood.Run(
                seed, [](const CellBlock&) { return false; },
                [](const CellBlock& block) { return block.x0; },
                [&](const CellBlock& block) {
                  flood.Offer({block.plane, block.x0 - 1, block.y0, block.x0, block.y1});
                  flood.Offer({block.plane, block.x1, block.y0, block.x1 + 1, block.y1});
                  flood.Offer({block.plane, block.x0, block.y0 - 1, block.x1, block.y0});
                  flood.Offer({block.plane, block.x0, block.y1, block.x1, block.y1 + 1});
                  for (const Maze::Link& link : maze->links) {
                    if (Overlap(link.from, block)) flood.Offer(link.to);
                  }
                },
                [&](const CellBlock& block) {
                  for (const Maze::Link& link : maze->late) {
                    flood.Offer(link.to, [&](const CellBlock&) {
                      for (int x = block.x0; x < block.x1; ++x) {
                        CellBlock column = block;
                        column.x0 = x;
                        column.x1 = x + 1;
                        if (x % 2 == 0 && Overlap(link.from, column)) return true;
                      }
                      return false;
                    });
                  }
                }),
            FloodEnd::kNothingLeft);
  std::vector<char> reached(maze->open.size(), 0);
  for (const BlockFlood::Reached& one : flood.reached()) {
    for (int x = one.block.x0; x < one.block.x1; ++x) {
      for (int y = one.block.y0; y < one.block.y1; ++y) {
        char& cell = reached[(static_cast<size_t>(one.block.plane) * maze->nx + x) * maze->ny + y];
        EXPECT_EQ(cell, 0) << "blocks are disjoint";
        cell = 1;
      }
    }
  }
  return reached;
}

TEST(BlockFloodTest, ReachesWhatAFloodOverSingleCellsReaches) {
  std::mt19937 generator(31);
  std::int64_t reached = 0, left = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Maze maze(&generator);
    const CellBlock seed = maze.RandomBlock(&generator, 1);
    const std::vector<char> dense = FloodCellByCell(&maze, seed);
    ASSERT_EQ(SparseFlood(&maze, seed), dense) << trial;
    const auto count = std::count(dense.begin(), dense.end(), 1);
    reached += count;
    left += std::count(maze.open.begin(), maze.open.end(), 1) - count;
  }
  EXPECT_GT(reached, 10000);
  EXPECT_GT(left, 10000);
}

/// A plane of 2^40 cells with one closed corner.
TEST(BlockFloodTest, MemoryGrowsWithTheBoundaryOnly) {
  constexpr int kSide = 1 << 20;
  BlockFlood flood(1, kSide, kSide,
                   [](const CellBlock& block) {
                     if (block.x0 >= 5 || block.y0 >= 5) return BlockState::kOpen;
                     return block.x1 <= 5 && block.y1 <= 5 ? BlockState::kClosed
                                                           : BlockState::kMixed;
                   },
                   {});
  const CellBlock goal = CellBlock::Of(0, kSide - 1, 0);
  const auto end = flood.Run(
      CellBlock::Of(0, 0, kSide - 1), [&](const CellBlock& block) { return block.Contains(goal); },
      [](const CellBlock&) { return 0.0; },
      [&](const CellBlock& block) {
        flood.Offer({0, block.x1, block.y0, block.x1 + 1, block.y1});
        flood.Offer({0, block.x0, block.y0 - 1, block.x1, block.y0});
      },
      [](const CellBlock&) {});
  EXPECT_EQ(end, FloodEnd::kGoal);
  EXPECT_LT(flood.judged(), 200);
  const std::vector<CellBlock> way = flood.WayToGoal();
  ASSERT_FALSE(way.empty());
  EXPECT_TRUE(way.front().Contains(CellBlock::Of(0, 0, kSide - 1)));
  EXPECT_TRUE(way.back().Contains(goal));
}

/// A chessboard has no block larger than a cell.
TEST(BlockFloodTest, LimitsCutTheFloodShort) {
  const auto chess = [](const CellBlock& block) {
    if (!block.IsCell()) return BlockState::kMixed;
    return (block.x0 + block.y0) % 2 == 0 ? BlockState::kOpen : BlockState::kClosed;
  };
  const auto flood_chess = [&](double side, const FloodLimits& limits) {
    BlockFlood flood(1, side, side, chess, limits);
    return flood.Run(
        CellBlock::Of(0, 0, 0), [](const CellBlock&) { return false; },
        [](const CellBlock&) { return 0.0; },
        [&](const CellBlock&) {
          flood.Offer({0, 0, 0, static_cast<int>(side), static_cast<int>(side)});
        },
        [](const CellBlock&) {});
  };
  EXPECT_EQ(flood_chess(256, {}), FloodEnd::kNothingLeft);
  EXPECT_EQ(flood_chess(256, {.most_judged = 1000}), FloodEnd::kCutShort);
  int asked = 0;
  EXPECT_EQ(flood_chess(256, {.cancellation = CancellationToken([&] { return ++asked < 100; })}),
            FloodEnd::kCutShort);
  EXPECT_EQ(asked, 100);
  EXPECT_EQ(flood_chess(1e12, {}), FloodEnd::kCutShort) << "more cells than can be counted";
  EXPECT_THROW(CellQuadtrees(1, 256, 256, 1000, chess)
                   .Offer({0, 0, 0, 256, 256}, {}, [](const CellBlock&) {}),
               TooManyCells);
}

TEST(CellQuadtreesTest, AnOpenCellIsEnteredOnceWhenAnOfferLeadsThere) {
  int judged = 0, entered = 0;
  CellQuadtrees cells(1, 4, 1, 100, [&](const CellBlock& block) {
    ++judged;
    return block.IsCell() ? BlockState::kOpen : BlockState::kMixed;
  });
  const CellBlock cell = CellBlock::Of(0, 2, 0);
  const auto enter = [&](const CellBlock& block) {
    ++entered;
    EXPECT_EQ(block, cell);
  };
  cells.Offer(
      cell, [](const CellBlock&) { return false; }, enter);
  EXPECT_EQ(entered, 0);
  const int judged_before = judged;
  cells.Offer(
      cell, [](const CellBlock&) { return true; }, enter);
  cells.Offer(cell, {}, enter);
  EXPECT_EQ(entered, 1);
  EXPECT_EQ(judged, judged_before) << "once";
}

}  // namespace
}  // namespace possibility::actions
