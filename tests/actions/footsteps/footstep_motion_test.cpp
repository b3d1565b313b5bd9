#include "actions/footsteps/footstep_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

const Foothold kPlace{{3, -2, 0}, 0.2};

/// The feet come beside each other again, 0.2 m ahead.
std::vector<Footstep> TwoSteps() {
  const Foothold ahead{{3.2, -2, 0}, 0.2};
  std::vector<Footstep> steps(2);
  for (int limb = 0; limb < 2; ++limb) {
    steps[limb].limb = limb;
    steps[limb].from = kPlace;
    steps[limb].to = ahead;
  }
  return steps;
}

const FootstepMotion& WalkingMotion() {
  static const FootstepMotion motion(DrcHubo1(), DrcHubo1Locomotion().gaits[0]->stance);
  return motion;
}

TEST(FootstepMotionTest, TheRoughMotionIsLikeTheMotion) {
  std::vector<Phase> rough;
  const auto keep = [&rough](const std::vector<Phase>& seen) { rough = seen; };
  const std::vector<Phase> motion = WalkingMotion().Build(kPlace, TwoSteps(), {}, nullptr, 1, keep);
  ASSERT_EQ(rough.size(), motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    for (const bool at_end : {false, true}) {
      const Knot& one = at_end ? rough[i].knots.back() : rough[i].knots.front();
      const Knot& other = at_end ? motion[i].knots.back() : motion[i].knots.front();
      EXPECT_NEAR(one.t, other.t, 1e-9) << i;
      // The root's way is coarser; PlannedSteps leaves 20 mm for it.
      EXPECT_LT((one.q.segment<3>(4) - other.q.segment<3>(4)).norm(), 0.02) << i;
    }
  }
}

TEST(FootstepMotionTest, AHitOfTheRoughMotionEndsTheBuilding) {
  int asked = 0;
  const auto refuse = [&asked](const std::vector<Phase>&) {
    ++asked;
    throw FootstepError("hits 'wall'", 1, FootstepError::Hit::kSwinging);
  };
  int style = 0;
  try {
    WalkingMotion().Build(kPlace, TwoSteps(), {}, &style, 1, refuse);
    FAIL() << "the hit was not reported";
  } catch (const FootstepError& error) {
    EXPECT_STREQ(error.what(), "hits 'wall'");
    EXPECT_EQ(error.step(), 1);
    EXPECT_EQ(error.hit(), FootstepError::Hit::kSwinging);
  }
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(style, 0);
}

TEST(FootstepMotionTest, OneLimbSwingsInEverySecondPhase) {
  const std::vector<Phase> motion = WalkingMotion().Build(kPlace, TwoSteps());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    EXPECT_EQ(motion[i].contacts.size(), FootstepMotion::SwingsIn(static_cast<int>(i)) ? 1U : 2U);
  }
}

}  // namespace
}  // namespace possibility::actions
