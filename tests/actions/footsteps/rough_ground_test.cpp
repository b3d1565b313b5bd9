#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "actions/motion/motion_schedule.h"
#include "actions/planner/planner.h"
#include "tests/actions/footsteps/uneven_world.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

/// From x = -0.8 to 2.2 over a floor with a strip of other ground from 0.3 to 1.1.
models::Scenario StripOfGround(double friction) {
  UnevenWorld world;
  world.Ground(-3, 0.3, 0).Ground(0.3, 1.1, 0).Ground(1.1, 5, 0);
  world.environment.obstacles[1].friction = friction;
  world.environment.bounds = {Eigen::Vector2d(-2, -1), Eigen::Vector2d(4, 1)};
  models::Scenario scenario = ShippedScenario("crack");
  scenario.environment = world.environment;
  scenario.start.x = -0.8;
  scenario.start.y = 0;
  scenario.goals[0].x = 2.2;
  scenario.goals[0].y = 0;
  return scenario;
}

PlanResult Planned(const models::Scenario& scenario) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  return PlanTraversal(DrcHubo1(), scenario, request);
}

bool StepsAreAmongTheExplorers(const PlanResult& result) {
  const auto& explorers = result.plan.search->explorers;
  return std::find(explorers.begin(), explorers.end(), "footsteps") != explorers.end();
}

TEST(SlipperyGround, IsCrossedWithinItsFriction) {
  const models::Scenario scenario = StripOfGround(0.25);
  const PlanResult result = Planned(scenario);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  EXPECT_TRUE(StepsAreAmongTheExplorers(result));
  // The same motion slips where there is less.
  const VerificationReport on_ice = Verify(result.plan, DrcHubo1(), StripOfGround(0.02));
  EXPECT_TRUE(std::any_of(
      on_ice.violations.begin(), on_ice.violations.end(),
      [](const Violation& violation) { return violation.kind == ViolationKind::kFriction; }));
}

TEST(SlipperyGround, AMotionForOtherGroundSlipsOnIt) {
  const models::Scenario dry = StripOfGround(models::kRobotsFriction);
  const PlanResult result = Planned(dry);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_FALSE(StepsAreAmongTheExplorers(result));
  models::Scenario icy = StripOfGround(0.05);
  icy.content_hash = dry.content_hash;
  const VerificationReport report = Verify(result.plan, DrcHubo1(), icy);
  ASSERT_FALSE(report.accepted());
  EXPECT_EQ(report.violations.front().kind, ViolationKind::kFriction);
}

TEST(SlipperyGround, AsMuchFrictionAsTheRobotHasChangesNothing) {
  const PlanResult result = Planned(StripOfGround(DrcHubo1().friction + 0.1));
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_FALSE(StepsAreAmongTheExplorers(result));
}

/// A box across the way that is too high and too deep to be stepped over.
models::Scenario BoxInTheWay(bool bears) {
  models::Scenario scenario = StripOfGround(models::kRobotsFriction);
  models::Obstacle box;
  box.name = "box";
  box.shape = models::Shape::Box({0.7, 3, 0.14});
  box.X_WO.translation() = Eigen::Vector3d(0.7, 0, 0.07);
  box.is_ground = bears;
  box.is_for_steps = bears;
  scenario.environment.obstacles.push_back(box);
  return scenario;
}

TEST(BearingObstacle, IsSteppedOnto) {
  EXPECT_NE(Planned(BoxInTheWay(false)).status, PlanStatus::kFound);
  const PlanResult result = Planned(BoxInTheWay(true));
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
}

}  // namespace
}  // namespace possibility::actions
