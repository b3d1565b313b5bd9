#include "actions/footsteps/footstep_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "actions/footsteps/step_refusals.h"
#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

class FootstepPlanTest : public ::testing::Test {
 protected:
  FootstepSearch::Status Search(UnevenWorld* world, const GroundedStance& start,
                                const GroundedStance& goal) {
    search_.emplace(WalkingHubo(), 0, world->Built(), start, std::vector<GroundedStance>{goal},
                    limits_);
    FootstepSearch::Status status = FootstepSearch::Status::kSearching;
    while (status == FootstepSearch::Status::kSearching) status = search_->Advance(100);
    return status;
  }

  /// Every corner of every sole is on ground of the step's height, away from its edge.
  void ExpectFootholds(const UnevenWorld& world) const {
    for (const Footstep& step : search_->steps()) {
      for (const Eigen::Vector2d& p : stance_.bearing_points[step.limb]) {
        const auto level = world.ground->LevelAt(step.to.stance * p, step.to.z, 1e-9);
        ASSERT_TRUE(level);
        EXPECT_GE(world.ground->Clearance(*level, step.to.stance * p), limits_.margin - 1e-6);
      }
    }
  }

  /// Limbs take turns, and each step begins where the limb stands.
  void ExpectSequence(const GroundedStance& start, const GroundedStance& goal) const {
    std::array<Foothold, 2> feet;
    feet.fill({start.pose, start.z});
    for (std::size_t i = 0; i < search_->steps().size(); ++i) {
      const Footstep& step = search_->steps()[i];
      if (i > 0) {
        EXPECT_NE(step.limb, search_->steps()[i - 1].limb);
      }
      EXPECT_EQ(step.from.stance.x, feet[step.limb].stance.x);
      EXPECT_EQ(step.from.z, feet[step.limb].z);
      EXPECT_LE(std::abs(step.to.z - feet[1 - step.limb].z), limits_.rise + 1e-6);
      feet[step.limb] = step.to;
    }
    for (const Foothold& foot : feet) {
      EXPECT_LT((foot.stance.position() - goal.pose.position()).norm(), 1e-9);
      EXPECT_NEAR(foot.z, goal.z, 1e-9);
    }
  }

  const NominalStance& stance_ = WalkingHubo().gaits[0]->stance;
  FootstepLimits limits_ = FootstepLimits::Of(DrcHubo1(), stance_);
  std::optional<FootstepSearch> search_;
};

TEST_F(FootstepPlanTest, CrossesACrack) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.12, 3, 0);
  const auto start = UnevenWorld::StanceAt(-1), goal = UnevenWorld::StanceAt(1.2);
  ASSERT_EQ(Search(&world, start, goal), FootstepSearch::Status::kFound);
  ExpectFootholds(world);
  ExpectSequence(start, goal);
}

/// Two planks at two heights: feet are never beside each other on one plane.
TEST_F(FootstepPlanTest, WalksWithEachFootOnAPlankOfItsOwn) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(1.5, 4, 0);
  const double side = stance_.patch_centres[0].y();
  world.Add({1.5, 0.2, 0.5}, {0.75, side + 0.02, 0.04 - 0.25}, true);
  world.Add({1.5, 0.2, 0.5}, {0.75, -side - 0.02, -0.02 - 0.25}, true);
  const auto start = UnevenWorld::StanceAt(-1), goal = UnevenWorld::StanceAt(2.4);
  ASSERT_EQ(Search(&world, start, goal), FootstepSearch::Status::kFound);
  ExpectFootholds(world);
  ExpectSequence(start, goal);
}

TEST_F(FootstepPlanTest, ClimbsStairs) {
  UnevenWorld world = UnevenWorld::Stairs(0.1);
  const auto start = UnevenWorld::StanceAt(-1), goal = UnevenWorld::StanceAt(3, 0.6);
  ASSERT_EQ(Search(&world, start, goal), FootstepSearch::Status::kFound);
  ExpectFootholds(world);
  ExpectSequence(start, goal);
}

TEST_F(FootstepPlanTest, LiftsFeetOverASill) {
  UnevenWorld world;
  world.Ground(-3, 4, 0).Box({0.06, 4, 0.08}, {0.4, 0, 0.04});
  const auto start = UnevenWorld::StanceAt(-1), goal = UnevenWorld::StanceAt(1.5);
  ASSERT_EQ(Search(&world, start, goal), FootstepSearch::Status::kFound);
  ExpectSequence(start, goal);
  for (const int limb : {0, 1}) {
    double highest = 0;
    for (const Footstep& step : search_->steps()) {
      if (step.limb == limb) highest = std::max(highest, step.lift);
    }
    EXPECT_GE(highest, 0.08);
  }
}

TEST_F(FootstepPlanTest, GoesThroughADoorSideways) {
  UnevenWorld world;
  world.Ground(-3, 4, 0).Box({0.1, 1.5, 2}, {0.4, 1.11, 1}).Box({0.1, 1.5, 2}, {0.4, -1.11, 1});
  const auto start = UnevenWorld::StanceAt(-1), goal = UnevenWorld::StanceAt(2);
  limits_.trunk_margin = 0.02;
  ASSERT_EQ(Search(&world, start, goal), FootstepSearch::Status::kFound);
  const auto& steps = search_->steps();
  const auto in_door = std::find_if(steps.begin(), steps.end(), [](const Footstep& step) {
    return std::abs(step.to.stance.x - 0.4) < 0.1;
  });
  ASSERT_NE(in_door, steps.end());
  EXPECT_NEAR(std::abs(std::sin(in_door->to.stance.yaw)), 1, 0.01);
}

TEST_F(FootstepPlanTest, NoWayIsExhausted) {
  UnevenWorld chasm;
  chasm.Ground(-3, 0, 0).Ground(0.8, 4, 0);
  EXPECT_EQ(Search(&chasm, UnevenWorld::StanceAt(-1), UnevenWorld::StanceAt(2)),
            FootstepSearch::Status::kExhausted);
  UnevenWorld cliff;
  cliff.Ground(-3, 0, 0).Ground(0, 4, 0.3);
  EXPECT_EQ(Search(&cliff, UnevenWorld::StanceAt(-1), UnevenWorld::StanceAt(2, 0.3)),
            FootstepSearch::Status::kExhausted);
}

TEST_F(FootstepPlanTest, TheSameSearchFindsTheSameSteps) {
  std::vector<double> places[2];
  for (std::vector<double>& run : places) {
    UnevenWorld world = UnevenWorld::Stairs(0.1);
    ASSERT_EQ(Search(&world, UnevenWorld::StanceAt(-1), UnevenWorld::StanceAt(3, 0.6)),
              FootstepSearch::Status::kFound);
    for (const Footstep& step : search_->steps()) {
      run.insert(run.end(), {step.to.stance.x, step.to.stance.y, step.to.z, step.lift});
    }
  }
  EXPECT_EQ(places[0], places[1]);
}

/// Strips of ground across the way. Another search, over the positions of both feet on a line in
/// steps of 1 cm, tells whether a robot can cross them straight ahead with steps that are somewhat
/// shorter than the family's.
/// The steps that are found are steps between their places; others are not.
TEST_F(FootstepPlanTest, AStepBetweenPlacesKeepsToReachAndObstacles) {
  UnevenWorld world;
  world.Ground(-3, 4, 0).Box({0.06, 3, 0.1}, {0.3, 0, 0.05}).Box({0.06, 3, 0.6}, {2.3, 0, 0.3});
  ASSERT_EQ(Search(&world, UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(1)),
            FootstepSearch::Status::kFound);
  std::vector<Foothold> feet(2, Foothold{UnevenWorld::StanceAt(-0.5).pose, 0});
  for (const Footstep& step : search_->steps()) {
    const auto again = search_->StepBetween(feet, step.limb, step.to);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->lift, step.lift);
    feet[step.limb] = step.to;
  }
  const auto at = [](double x, double y = 0) {
    return Foothold{UnevenWorld::StanceAt(x, 0, y).pose, 0};
  };
  EXPECT_TRUE(search_->StepBetween({at(1), at(1)}, 0, at(1.2)));
  EXPECT_FALSE(search_->StepBetween({at(1), at(1)}, 0, at(2))) << "out of reach";
  EXPECT_FALSE(search_->StepBetween({at(2), at(2.2)}, 0, at(2.6))) << "over the wall";
  const double aside = 2 * (stance_.patch_centres[1].y() - stance_.patch_centres[0].y());
  EXPECT_FALSE(search_->StepBetween({at(1), at(1)}, 0, at(1, aside))) << "through the other foot";
}

class StripsTest : public FootstepPlanTest {
 protected:
  struct Strip {
    double from = 0, to = 0, z = 0;
  };

  std::vector<Strip> RandomStrips() {
    std::uniform_real_distribution<double> length(0.32, 0.8), gap(0, 0.08), height(0, 0.05),
        share(0, 1);
    std::vector<Strip> strips = {{-3, 0, 0}};
    while (strips.back().to < 1.5) {
      const double from = strips.back().to + (share(random_) < 0.1 ? 0.6 : gap(random_));
      strips.push_back({from, from + length(random_), height(random_)});
    }
    strips.back().to = 5;
    return strips;
  }

  /// Index of the strip that a foot of the stance at x bears on, well away from the edges; -1.
  int StripAt(const std::vector<Strip>& strips, double x) const {
    for (std::size_t i = 0; i < strips.size(); ++i) {
      bool bears = true;
      for (const Eigen::Vector2d& p : stance_.bearing_points[0]) {
        bears = bears && x + p.x() > strips[i].from + 0.015 && x + p.x() < strips[i].to - 0.015;
      }
      if (bears) return static_cast<int>(i);
    }
    return -1;
  }

  bool LineIsCrossed(const std::vector<Strip>& strips, double start, double goal) const {
    const auto cells = static_cast<int>((goal - start) / kStep) + 1;
    const auto most = static_cast<int>((limits_.forward - 0.02) / kStep);
    // Whether one foot may stand in a cell while the other one is that many cells behind.
    std::vector<std::vector<bool>> known(cells, std::vector<bool>(most + 1, false));
    std::vector<std::pair<int, int>> open = {{0, 0}};
    while (!open.empty()) {
      const auto [ahead, behind] = open.back();
      open.pop_back();
      for (int cell = ahead; cell <= std::min(cells - 1, ahead + most); ++cell) {
        if (StripAt(strips, start + cell * kStep) < 0 || known[cell][cell - ahead]) continue;
        known[cell][cell - ahead] = true;
        open.emplace_back(cell, cell - ahead);
      }
    }
    return known[cells - 1][0];
  }

  static constexpr double kStep = 0.01;  // m
  std::mt19937 random_{4};
};

TEST_F(StripsTest, WhatIsCrossedOnALineIsFound) {
  int crossed = 0, found = 0;
  constexpr int kWorlds = 100;
  for (int i = 0; i < kWorlds; ++i) {
    const std::vector<Strip> strips = RandomStrips();
    UnevenWorld world;
    for (const Strip& strip : strips) world.Ground(strip.from, strip.to, strip.z);
    const double end = strips.back().from + 0.5;
    const auto start = UnevenWorld::StanceAt(-0.5);
    const auto goal = UnevenWorld::StanceAt(end, strips.back().z);
    const bool is_crossed = LineIsCrossed(strips, -0.5, end);
    const bool is_found = Search(&world, start, goal) == FootstepSearch::Status::kFound;
    EXPECT_TRUE(is_found || !is_crossed) << "world " << i;
    crossed += is_crossed;
    found += is_found;
    if (!is_found) continue;
    ExpectFootholds(world);
    ExpectSequence(start, goal);
  }
  EXPECT_GT(crossed, 5);
  EXPECT_LT(found, kWorlds);
}

TEST(StepRefusalsTest, ALongerOrHigherStepThanOneThatFailedIsRefused) {
  StepRefusals refusals(StepRefusals::Breadth::kBeyond);
  const Footstep failed{0, {{-0.2, 0, 0}, 0}, {{0.25, 0, 0}, 0.1}, 0};
  const Foothold other{{0, 0, 0}, 0};
  refusals.Add(failed, other);
  EXPECT_TRUE(refusals.Refuses(failed, other));
  Footstep step = failed;
  step.to.stance.x = 0.3;
  EXPECT_TRUE(refusals.Refuses(step, other));
  step.to.stance.x = 0.2;
  EXPECT_FALSE(refusals.Refuses(step, other));
  step = failed;
  step.to.z = 0.05;
  EXPECT_FALSE(refusals.Refuses(step, other));
  step = failed;
  step.to.z = -0.1;  // down is not up
  EXPECT_FALSE(refusals.Refuses(step, other));
}

/// The posture at the beginning of a step is as bad at the end of another one.
TEST(StepRefusalsTest, AnEndThatFailedIsRefusedInEveryStep) {
  StepRefusals refusals(StepRefusals::Breadth::kBeyond);
  const Foothold other{{1, 2, 0.5}, 0.1};
  const auto at = [&other](double ahead, double aside, double turn, double z) {
    return Foothold{other.stance * PlanarPose{ahead, aside, turn}, z};
  };
  refusals.AddEnd(at(0.2, 0.1, 0, 0.1), other);
  const Foothold near = at(0, 0, 0, 0.1);
  EXPECT_TRUE(refusals.Refuses({0, at(0.2, 0.1, 0, 0.1), near, 0}, other));
  EXPECT_TRUE(refusals.Refuses({1, near, at(0.25, -0.1, 0.2, 0.1), 0.1}, other));
  EXPECT_FALSE(refusals.Refuses({0, near, near, 0.2}, other));
  EXPECT_FALSE(refusals.Refuses({0, at(0.3, 0.05, 0, 0.1), near, 0}, other));
  EXPECT_FALSE(refusals.Refuses({0, at(0.15, 0.15, 0, 0.1), near, 0}, other));
  EXPECT_FALSE(refusals.Refuses({0, at(-0.2, 0.1, 0, 0.1), near, 0}, other)) << "behind";
}

/// Toes that point away from the other foot are another matter than toes that point at it.
TEST(StepRefusalsTest, AnEndIsRefusedOnBothSidesButTurnedOneWayOnly) {
  StepRefusals refusals(StepRefusals::Breadth::kBeyond);
  const Foothold other{{1, 2, 0.5}, 0.1};
  const auto at = [&other](double aside, double turn) {
    return Foothold{other.stance * PlanarPose{0.1, aside, turn}, 0.1};
  };
  const Foothold near{other.stance, 0.1};
  refusals.AddEnd(at(0.1, 0.3), other);
  EXPECT_TRUE(refusals.Refuses({0, at(0.1, 0.35), near, 0}, other));
  EXPECT_TRUE(refusals.Refuses({1, at(-0.1, -0.35), near, 0}, other)) << "the mirror image";
  EXPECT_FALSE(refusals.Refuses({0, at(0.1, -0.35), near, 0}, other));
  EXPECT_FALSE(refusals.Refuses({1, at(-0.1, 0.35), near, 0}, other));
}

}  // namespace
}  // namespace possibility::actions
