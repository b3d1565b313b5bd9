#include "actions/footholds/foothold_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

/// Steps take 1 s up to 0.4 m, and 1 s more for each decimetre up or down, up to 0.16 m.
FootholdField::StepTimes Steps() {
  FootholdField::StepTimes steps;
  steps.pace = 2;
  for (int row = 0; row * steps.spacing <= 0.16; ++row) {
    std::vector<double> times(40, std::numeric_limits<double>::infinity());
    for (int i = 0; i * steps.spacing <= 0.4; ++i) times[i] = 1 + 10 * row * steps.spacing;
    steps.times.push_back(times);
  }
  return steps;
}

class FootholdFieldTest : public ::testing::Test {
 protected:
  FootholdField FieldTo(UnevenWorld* world, const GroundedStance& goal) {
    const World& built = world->Built();
    planes_.clear();
    for (int i = 0; i < static_cast<int>(built.ground->planes().size()); ++i) planes_.push_back(i);
    const NominalStance& stance = WalkingHubo().gaits[0]->stance;
    cells_.emplace_back(stance, built, planes_, limits_);
    return FootholdField(cells_.back(), stance, built, limits_, {goal}, {}, Steps());
  }

  FootstepLimits limits_ = FootstepLimits::Of(DrcHubo1(), WalkingHubo().gaits[0]->stance);
  std::vector<int> planes_;
  std::deque<FootholdCells> cells_;
};

TEST_F(FootholdFieldTest, OnGroundThatHangsTogetherTimeGrowsWithThePace) {
  UnevenWorld world;
  world.Ground(-3, 4, 0);
  FootholdField field = FieldTo(&world, UnevenWorld::StanceAt(2));
  EXPECT_NEAR(field.At(0, {-1, 0, 0}, 0), 6, 0.3);
  EXPECT_NEAR(field.At(0, {2, 0, 0}, 0), 0, 0.2);
}

TEST_F(FootholdFieldTest, ALevelTooHighIsNotReached) {
  UnevenWorld low, high;
  low.Ground(-3, 0, 0).Ground(0, 4, 0.1);
  high.Ground(-3, 0, 0).Ground(0, 4, 0.3);
  FootholdField up = FieldTo(&low, UnevenWorld::StanceAt(2, 0.1));
  EXPECT_TRUE(std::isfinite(up.At(0, {-1, 0, 0}, 0)));
  FootholdField none = FieldTo(&high, UnevenWorld::StanceAt(2, 0.3));
  EXPECT_TRUE(std::isinf(none.At(0, {-1, 0, 0}, 0)));
}

TEST_F(FootholdFieldTest, AGapLongerThanAStepIsNotCrossed) {
  UnevenWorld narrow, wide;
  narrow.Ground(-3, 0, 0).Ground(0.1, 4, 0);
  wide.Ground(-3, 0, 0).Ground(0.6, 4, 0);
  EXPECT_TRUE(std::isfinite(FieldTo(&narrow, UnevenWorld::StanceAt(2)).At(0, {-1, 0, 0}, 0)));
  EXPECT_TRUE(std::isinf(FieldTo(&wide, UnevenWorld::StanceAt(2)).At(0, {-1, 0, 0}, 0)));
}

}  // namespace
}  // namespace possibility::actions
