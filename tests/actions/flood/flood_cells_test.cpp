// Blocks of cells compared with single cells, in random scenes.

#include <gtest/gtest.h>

#include <random>

#include "actions/flood/blocks_from_above.h"
#include "actions/flood/pelvis_cells.h"
#include "actions/flood/route_flood.h"
#include "actions/flood/stance_cells.h"
#include "actions/flood/sufficient_flood.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/flood/dense_flood.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// A square of cells that is a power of two wide, and some of its cells.
template <typename Cells>
void ExpectAgreement(const Cells& cells, const CellBlock& block, std::mt19937* generator,
                     std::map<BlockState, int>* verdicts) {
  const BlockState state = cells.Judge(block);
  ++(*verdicts)[state];
  if (state == BlockState::kMixed) return;
  std::uniform_int_distribution<int> x(block.x0, block.x1 - 1), y(block.y0, block.y1 - 1);
  for (int i = 0; i < 12; ++i) {
    // Corners first.
    const CellBlock cell = i < 4 ? CellBlock::Of(block.plane, i & 1 ? block.x0 : block.x1 - 1,
                                                 i & 2 ? block.y0 : block.y1 - 1)
                                 : CellBlock::Of(block.plane, x(*generator), y(*generator));
    EXPECT_EQ(cells.Judge(cell), state);
  }
}

template <typename Cells>
std::map<BlockState, int> ExpectBlocksAgree(const Cells& cells, int planes, int nx, int ny,
                                            std::mt19937* generator) {
  std::map<BlockState, int> verdicts;
  for (int i = 0; i < 1500; ++i) {
    const int size = 2 << ((*generator)() % 4);
    CellBlock block = CellBlock::Of(static_cast<int>((*generator)() % planes),
                                    static_cast<int>((*generator)() % nx) / size * size,
                                    static_cast<int>((*generator)() % ny) / size * size);
    block.x1 = std::min(nx, block.x0 + size);
    block.y1 = std::min(ny, block.y0 + size);
    if (block.IsCell()) continue;
    ExpectAgreement(cells, block, generator, &verdicts);
  }
  return verdicts;
}

TEST(FloodCellsTest, StanceBlocksAgreeWithTheirCells) {
  std::mt19937 generator(41);
  std::map<BlockState, int> all;
  for (int trial = 0; trial < 12; ++trial) {
    const models::Environment environment = RandomEnvironment(&generator, 6);
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    const StanceCells cells(DrcHubo1Locomotion(), world, ground.levels(), 0.3,
                            {.resolution = trial % 2 ? 0.1 : 0.07,
                             .headings = trial % 2 ? 24 : 30,
                             .halvings = trial % 3,
                             .leniency = trial % 4 == 3 ? 0.05 : 0});
    const Eigen::Vector2i size = cells.NumCells().cast<int>();
    for (const auto& [state, count] :
         ExpectBlocksAgree(cells, cells.num_planes(), size.x(), size.y(), &generator)) {
      all[state] += count;
    }
  }
  EXPECT_GT(all[BlockState::kOpen], 500);
  EXPECT_GT(all[BlockState::kClosed], 200);
}

TEST(FloodCellsTest, PelvisBlocksAgreeWithTheirCells) {
  std::mt19937 generator(42);
  std::map<BlockState, int> all;
  for (int trial = 0; trial < 8; ++trial) {
    const models::Environment environment = RandomEnvironment(&generator, 30);
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    const PelvisCells cells(DrcHubo1Locomotion(), world, 0.1, trial % 2 ? 1 : 0.3, {0.1, 0.2});
    const Eigen::Vector3i size = cells.num_cells().cast<int>();
    for (const auto& [state, count] :
         ExpectBlocksAgree(cells, size.z(), size.x(), size.y(), &generator)) {
      all[state] += count;
    }
  }
  EXPECT_GT(all[BlockState::kOpen], 500);
  EXPECT_GT(all[BlockState::kClosed], 500);
}

/// Regions reached by strides, transitions and leaps. Some of the leaps are too short for the gap.
TEST(FloodCellsTest, TheFloodReachesWhatADenseOneReaches) {
  std::mt19937 generator(43);
  std::uniform_real_distribution<double> unit(0, 1);
  const LocomotionModel& model = DrcHubo1Locomotion();
  double reached = 0, far_side = 0;
  for (int trial = 0; trial < 3; ++trial) {
    models::Environment environment = RandomEnvironment(&generator, 8);
    environment.bounds = {Vector2d(-2, -1.5), Vector2d(2, 1.5)};
    environment.obstacles[1].X_WO.translation().x() += 0.5 * unit(generator);
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    const double length = 0.6 + 0.6 * unit(generator);
    const LandingRange range{{Vector2d(0.2, 0), Vector2d(length, trial % 2 ? 0.1 : 0)},
                             trial % 3 ? 0.0 : 0.2};
    const std::vector<FloodManoeuvre> manoeuvres = {
        {0, 1,
         [=](double rise) { return std::abs(rise) < 1e-6 ? std::optional(range) : std::nullopt; }}};
    const GroundedStance start{0, RandomStance(&generator, 1.2), 0};
    DenseFlood dense(model, world, 0.1, manoeuvres);
    dense.Run(start);
    const FloodResult sparse =
        FloodSufficient(model, world, start, {{0, {100, 0, 0}, 0}}, {}, {}, manoeuvres);
    ASSERT_FALSE(sparse.route_may_exist);
    std::vector<ReachedRegion> regions;
    const StanceCells cells(model, world, ground.levels(), 0, {});
    for (int layer = 0; layer < dense.size()[0]; ++layer) {
      std::vector<CellBlock> blocks;
      for (int x = 0; x < dense.size()[1]; ++x) {
        for (int y = 0; y < dense.size()[2]; ++y) {
          for (int heading = 0; heading < dense.size()[3]; ++heading) {
            if (!dense.IsReached({layer, x, y, heading})) continue;
            blocks.push_back(CellBlock::Of(0, x, y));
            ++reached;
          }
        }
      }
      if (blocks.empty()) continue;
      double margin = 0;
      for (const auto& transition : model.transitions) {
        margin = std::max(margin, transition.displacement.position().norm());
      }
      const std::vector<GroundedStance> no_goals;
      const BlocksFromAbove view(environment.bounds.min() - Vector2d::Constant(margin),
                                 Vector2d::Constant(0.1), no_goals);
      regions.push_back(
          {model.gaits[static_cast<size_t>(layer) % model.gaits.size()]->stance.gait->name, 0,
           view.OutlinesOf(blocks, {dense.size()[1], dense.size()[2]}, {})});
    }
    ASSERT_EQ(sparse.barrier.reached.size(), regions.size()) << trial;
    for (size_t i = 0; i < regions.size(); ++i) {
      EXPECT_EQ(sparse.barrier.reached[i].action, regions[i].action);
      EXPECT_EQ(sparse.barrier.reached[i].outlines, regions[i].outlines) << trial;
    }
    far_side += sparse.barrier.reached.size() > 1;
  }
  EXPECT_GT(reached, 3e4);
  EXPECT_GT(far_side, 0);
}

}  // namespace
}  // namespace possibility::actions
