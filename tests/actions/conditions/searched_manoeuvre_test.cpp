#include "actions/conditions/searched_manoeuvre.h"

#include <gtest/gtest.h>

#include "models/input/input_error.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

graph::Edge EdgeOf(const graph::NonholonomicAction& leap) {
  const graph::Point from = *leap.FindLaunchPoint(ToPoint(PlanarPose{-1, 0, 0}.At(1)), {});
  return {from, leap.ExtendTowards(from, {})};
}

TEST(SearchedManoeuvreTest, AConfirmedEdgeMeetsSufficientConditions) {
  const Context context(PitScene(true).environment);
  const SearchedManoeuvre leap(std::make_shared<Leap>(*context, Confirms, Slides));
  const graph::Edge edge = EdgeOf(leap);
  EXPECT_TRUE(leap.Explorable(edge));
  EXPECT_FALSE(leap.CS(edge));
  graph::JobControl control;
  EXPECT_EQ(leap.SpawnConfirmationJob(edge)->Run(&control), graph::JobVerdict::kConfirmed);
  EXPECT_TRUE(leap.CS(edge));
  EXPECT_TRUE(leap.Refusals().empty());
}

TEST(SearchedManoeuvreTest, AnUndecidedJobLeavesNoVerdict) {
  const Context context(PitScene(true).environment);
  const SearchedManoeuvre leap(std::make_shared<Leap>(
      *context, [](graph::JobControl*) { return graph::JobVerdict::kUndecided; }, Slides));
  const graph::Edge edge = EdgeOf(leap);
  graph::JobControl control;
  EXPECT_EQ(leap.SpawnConfirmationJob(edge)->Run(&control), graph::JobVerdict::kUndecided);
  EXPECT_TRUE(leap.Explorable(edge));
  EXPECT_FALSE(leap.CS(edge));
  EXPECT_TRUE(leap.Refusals().empty());
}

TEST(SearchedManoeuvreTest, TheLatestVerdictOnAnEdgeHolds) {
  const Context context(PitScene(true).environment);
  SearchedManoeuvre leap(std::make_shared<Leap>(*context, Confirms, Slides));
  const graph::Edge edge = EdgeOf(leap);
  graph::JobControl control;
  leap.SpawnConfirmationJob(edge)->Run(&control);
  leap.Forbid(edge, "a reason", false);
  EXPECT_FALSE(leap.CS(edge));
  EXPECT_FALSE(leap.Explorable(edge));
  ASSERT_EQ(leap.Refusals().size(), 1u);
  EXPECT_EQ(leap.Refusals().front().reason, "a reason");
  leap.Forget(edge);
  EXPECT_TRUE(leap.Explorable(edge));
  EXPECT_TRUE(leap.Refusals().empty());
}

/// A manoeuvre that remembers which edges have a fault everywhere.
class RememberingLeap : public Leap {
 public:
  using Leap::Leap;
  void RefuteEverywhere(const graph::Edge&) override { ++refuted; }
  int refuted = 0;
};

TEST(SearchedManoeuvreTest, OnlyFaultsThatDoNotDependOnThePlaceReachTheManoeuvre) {
  const Context context(PitScene(true).environment);
  const auto inner = std::make_shared<RememberingLeap>(*context, Confirms, Slides);
  SearchedManoeuvre leap(inner);
  leap.Forbid(EdgeOf(leap), "an obstacle", false);
  EXPECT_EQ(inner->refuted, 0);
  leap.Forbid(EdgeOf(leap), "a torque", true);
  EXPECT_EQ(inner->refuted, 1);
}

TEST(SearchedManoeuvreTest, AThrowingConditionBecomesAnInputErrorOfOneLine) {
  const Context context(PitScene(true).environment);
  const SearchedManoeuvre leap(std::make_shared<Leap>(*context, Confirms, Slides,
                                                      [](const std::string& function) {
                                                        if (function == "CN")
                                                          throw std::runtime_error("two\nlines");
                                                      }),
                               "pit.yaml: actions");
  try {
    leap.CN(EdgeOf(leap));
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find("pit.yaml: actions: action 'vault': CN failed for the edge from"), 0u)
        << message;
    EXPECT_NE(message.find("two lines"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace possibility::actions
