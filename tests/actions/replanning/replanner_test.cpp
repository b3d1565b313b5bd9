#include "actions/replanning/replanner.h"

#include <gtest/gtest.h>

#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

PlanRequest WithLibrary() {
  PlanRequest request;
  request.library = DrcHubo1Library();
  return request;
}

/// What `possibility verify` does: from nothing, by the file's scenario.
void ExpectVerified(const PlanResult& result, const models::Scenario& scenario) {
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  const VerificationReport report = Verify(result.plan, DrcHubo1(), scenario);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

/// A box beside or in the way; its content hash differs from that of every other place.
models::Scenario WithBoxAt(double x, double y) {
  models::Scenario scenario = ShippedScenario("three_routes_a");
  models::Obstacle box;
  box.name = "box";
  box.shape = models::Shape::Box({0.3, 0.3, 1});
  box.X_WO.translation() = Eigen::Vector3d(x, y, 0.5);
  scenario.environment.obstacles.push_back(box);
  scenario.content_hash = fmt::format("{} {}", x, y);
  return scenario;
}

TEST(Replanner, KeepsAPlanThatTheChangeDoesNotTouch) {
  Replanner replanner;
  const Eigen::Vector2d far =
      ShippedScenario("three_routes_a").environment.bounds.max() + Eigen::Vector2d(3, 3);
  const models::Scenario before = WithBoxAt(far.x(), far.y());
  const PlanResult first = replanner.Plan(DrcHubo1(), before, WithLibrary());
  ExpectVerified(first, before);
  EXPECT_FALSE(replanner.reuse().plan);
  const models::Scenario after = WithBoxAt(far.x(), far.y() + 0.5);
  const PlanResult second = replanner.Plan(DrcHubo1(), after, WithLibrary());
  ExpectVerified(second, after);
  EXPECT_TRUE(replanner.reuse().plan);
  EXPECT_EQ(second.verification.kept_samples, second.verification.samples);
  EXPECT_EQ(second.plan.scenario_hash, after.content_hash);
  EXPECT_EQ(second.plan.duration(), first.plan.duration());
}

TEST(Replanner, PlansAnewWhereTheLastPlanIsInTheWay) {
  Replanner replanner;
  const models::Scenario empty = ShippedScenario("three_routes_a");
  const PlanResult first = replanner.Plan(DrcHubo1(), empty, WithLibrary());
  const Knot& start = first.plan.segments.front().phases.front().knots.front();
  const Knot& end = first.plan.segments.back().phases.back().knots.back();
  const models::Scenario blocked =
      WithBoxAt((start.q[4] + end.q[4]) / 2, (start.q[5] + end.q[5]) / 2);
  const PlanResult second = replanner.Plan(DrcHubo1(), blocked, WithLibrary());
  EXPECT_FALSE(replanner.reuse().plan);
  EXPECT_TRUE(replanner.reuse().model);
  ExpectVerified(second, blocked);
  // The same answer as without a memory.
  const PlanResult alone = PlanTraversal(DrcHubo1(), blocked, WithLibrary());
  EXPECT_EQ(second.status, alone.status);
  EXPECT_EQ(second.plan.duration(), alone.plan.duration());
}

TEST(Replanner, AnotherStartOrFewerActionsNeedAnotherPlan) {
  Replanner replanner;
  const models::Scenario scenario = ShippedScenario("three_routes_a");
  replanner.Plan(DrcHubo1(), scenario, WithLibrary());
  models::Scenario elsewhere = scenario;
  elsewhere.start.x += 0.1;
  elsewhere.content_hash += " start";
  ExpectVerified(replanner.Plan(DrcHubo1(), elsewhere, WithLibrary()), elsewhere);
  EXPECT_FALSE(replanner.reuse().plan);
  PlanRequest walk = WithLibrary();
  walk.actions = {"walk"};
  EXPECT_EQ(replanner.Plan(DrcHubo1(), elsewhere, walk).status, PlanStatus::kFound);
  EXPECT_FALSE(replanner.reuse().plan) << "the last plan crawls";
}

TEST(Replanner, GoalsMayComeAndGo) {
  Replanner replanner;
  const models::Scenario one = ShippedScenario("crack");
  replanner.Plan(DrcHubo1(), one, WithLibrary());
  models::Scenario two = one;
  models::Stance other = one.goals[0];
  other.y += 1;
  two.goals.insert(two.goals.begin(), other);
  two.content_hash += " goals";
  const PlanResult result = replanner.Plan(DrcHubo1(), two, WithLibrary());
  ExpectVerified(result, two);
  EXPECT_TRUE(replanner.reuse().plan);
  EXPECT_EQ(result.plan.goal, 1);
}

}  // namespace
}  // namespace possibility::actions
