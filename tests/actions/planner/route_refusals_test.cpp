#include "actions/planner/route_refusals.h"

#include <gtest/gtest.h>

namespace possibility::actions {
namespace {

VerificationReport Report(const std::vector<Violation>& violations) {
  VerificationReport report;
  report.violations = violations;
  return report;
}

const Violation kWrist = {
    ViolationKind::kPenetration, 1, 7.5, "left wrist against floor", -0.012, -0.0001, "m"};

TEST(RouteRefusals, ViolationsAreDescribedWithTheirMeasure) {
  EXPECT_EQ(Describe(kWrist), "penetration, left wrist against floor, -0.012 m (limit -0.0001)");
  EXPECT_EQ(Describe({ViolationKind::kFileMismatch, -1, 0, "robot", 1, 0, ""}),
            "file mismatch, robot");
}

TEST(RouteRefusals, WithoutRefusalsTheExplanationIsEmpty) {
  RouteRefusals refusals;
  refusals.ByVerification(Report({}), {"walk"});
  EXPECT_EQ(refusals.Explain(), "");
}

TEST(RouteRefusals, TheFirstRefusalIsNamedAndTheOthersAreCounted) {
  RouteRefusals refusals;
  refusals.ByVerification(Report({{ViolationKind::kStructure, -1, 0, "no segments", 1, 0, ""},
                                  {ViolationKind::kContactGround, 1, 9, "toe", 1, 0, "m"},
                                  kWrist}),
                          {"walk from here to there", "leap from there to nowhere"});
  EXPECT_EQ(refusals.Explain(),
            " 1 confirmed route came to nothing, 1 refused by verification; the first in leap from "
            "there to nowhere: penetration, left wrist against floor, -0.012 m (limit -0.0001).");
  refusals.ByVerification(Report({kWrist}), {});
  refusals.ByMotion("crawl from here to there", "out of reach");
  EXPECT_EQ(
      refusals.Explain(),
      " 3 confirmed routes came to nothing, 1 without a motion, 2 refused by verification; "
      "the first in leap from there to nowhere: penetration, left wrist against floor, -0.012 "
      "m (limit -0.0001).");
}

TEST(RouteRefusals, ARefusalByMotionGenerationNamesItsLegAndReason) {
  RouteRefusals refusals;
  refusals.ByMotion("crawl from here to there", "LKP would move at 13 rad/s");
  EXPECT_EQ(refusals.Explain(),
            " 1 confirmed route came to nothing, 1 without a motion; the first in crawl from here "
            "to there: LKP would move at 13 rad/s.");
}

/// The violation belongs to no leg, so the explanation names the violation only.
TEST(RouteRefusals, ARefusalOfNoLegNamesTheViolationOnly) {
  RouteRefusals refusals;
  refusals.ByVerification(Report({{ViolationKind::kRollout, -1, 0, "simulation fell", 1, 0, ""}}),
                          {"walk"});
  EXPECT_EQ(refusals.Explain(),
            " 1 confirmed route came to nothing, 1 refused by verification; the first in rollout, "
            "simulation fell.");
}

}  // namespace
}  // namespace possibility::actions
