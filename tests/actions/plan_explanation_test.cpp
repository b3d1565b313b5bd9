#include "actions/plan_explanation.h"

#include <gtest/gtest.h>

#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

Barrier At(double x, const std::vector<std::string>& closed_by) {
  Barrier barrier;
  barrier.closest = {x, -0.254};
  barrier.distance = 1.5;
  barrier.closed_by = closed_by;
  return barrier;
}

TEST(PlanExplanationTest, ABarrierSaysWhereAndWhat) {
  EXPECT_EQ(ExplainBarrier(PlanStatus::kExhausted, At(2, {"bar", "no ground"})),
            "no route exists that these actions could confirm: the search came within 1.50 m of a "
            "goal, at (2.00, -0.25); the way on is closed by bar, no ground.");
  EXPECT_EQ(ExplainBarrier(PlanStatus::kProvenInfeasible, At(2, {})),
            "no route exists within the scenario's bounds, not even for the pelvis alone: the "
            "search came within 1.50 m of a goal, at (2.00, -0.25); the way on is closed by the "
            "bounds.");
}

TEST(PlanExplanationTest, OnlyWhatWasTriedIsListed) {
  EXPECT_EQ(ExplainSearch({{"cycles", 0}, {"vertices", 2}}), "");
  EXPECT_EQ(ExplainSearch({{"cycles", 7}, {"edges", 0}, {"vertices", 2}}),
            " Tried: cycles 7; vertices 2.");
}

TEST(PlanExplanationTest, ManoeuvresAreExplainedByTheirFirstFewRefusals) {
  const Context context(PitScene(true).environment);
  const auto leap = std::make_shared<Leap>(
      *context, [](graph::JobControl*) { return graph::JobVerdict::kRefuted; },
      [](const Leap& l) { return l.Slide(); });
  EXPECT_EQ(ExplainManoeuvres({leap}, {}), "");
  const auto edge = [](double x) {
    return graph::PointPair{ToPoint(PlanarPose{x, 1, 0}.At(1)), ToPoint(PlanarPose{x, 2, 0}.At(1))};
  };
  leap->Record(edge(0), false, "a wall");
  EXPECT_EQ(ExplainManoeuvres({leap}, {}), " 1 of 'leap' refuted: from (0.00, 1.00): a wall.");
  for (int i = 1; i < 5; ++i) leap->Record(edge(i), false, "r" + std::to_string(i));
  EXPECT_EQ(ExplainManoeuvres({leap}, {{"leap", {{edge(9), "it threw"}}}, {"hop", {{}}}}),
            " 5 of 'leap' refuted: from (0.00, 1.00): a wall; from (1.00, 1.00): r1; from (2.00, "
            "1.00): r2; ... 1 jobs of 'leap' failed: from (9.00, 1.00): it threw.");
}

}  // namespace
}  // namespace possibility::actions
