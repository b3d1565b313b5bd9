#include "experiments/viewer/viewer_phases.h"

#include <gtest/gtest.h>

#include "models/input/input_error.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

using Names = std::vector<std::string>;

/// Phases with these bearing contacts, in order.
Names NamesOf(const std::vector<Names>& contacts) {
  actions::Segment segment{"any", {}};
  for (const Names& phase : contacts) segment.phases.push_back({phase, {}});
  return PhaseNames(testing::SampleRobot(), segment);
}

TEST(PhaseNames, OfACompleteJumpAreItsPhases) {
  EXPECT_EQ(NamesOf({{"sole"}, {"sole"}, {"sole[0,3]"}, {}, {"sole"}, {"sole"}, {"peg", "sole"}}),
            (Names{"preparation", "crouch", "toes", "flight", "settle", "settle", "landing"}));
}

TEST(PhaseNames, OfAnIncompleteJumpAreThePhasesItHas) {
  EXPECT_EQ(NamesOf({{"sole"}, {}, {"peg"}}), (Names{"crouch", "flight", "settle"}));
  EXPECT_EQ(NamesOf({{"sole[0]"}, {}}), (Names{"toes", "flight"}));
  EXPECT_EQ(NamesOf({{}}), (Names{"flight"}));
  EXPECT_EQ(NamesOf({{}, {"sole[0,3]"}, {}, {"sole", "peg"}}),
            (Names{"flight", "settle", "flight", "settle"}));
}

TEST(PhaseNames, OnTheGroundAreStanceAndSwings) {
  EXPECT_EQ(NamesOf({{"sole", "peg"}, {"peg"}, {"peg", "sole"}, {"sole"}}),
            (Names{"stance", "swing sole", "stance", "swing peg"}));
  EXPECT_EQ(NamesOf({{"sole"}}), (Names{"stance"}));
}

TEST(PhaseNames, WithSeveralLimbsOffTheGroundNameTheStanceLimb) {
  models::RobotModel robot = testing::SampleRobot();
  robot.contacts.push_back({"fist", 0, {{0, 0.2, 0}}});
  actions::Segment segment{"any", {{{"sole", "peg", "fist"}, {}}, {{"sole"}, {}}}};
  EXPECT_EQ(PhaseNames(robot, segment), (Names{"stance", "on sole"}));
}

TEST(PhaseNames, RefuseUnknownContacts) { EXPECT_THROW(NamesOf({{"third_foot"}}), InputError); }

}  // namespace
}  // namespace possibility::experiments
