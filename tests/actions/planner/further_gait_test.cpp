// Gaits from outside the robot's file (PlanRequest::gaits).
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/quasi_static_gait.h"
#include "actions/planner/planner.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"

namespace possibility::actions {
namespace {

models::Scenario Hall() {
  models::Scenario scenario;
  scenario.name = "hall";
  scenario.file = "hall.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk", "brisk"};
  scenario.start = {"walk", -2, 0, 0, 0};
  scenario.goals = {{"walk", 2, 0, 0, 0}};
  scenario.environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -2), Eigen::Vector2d(3, 2));
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({6, 4, 0.2});
  floor.X_WO.translation().z() = -0.1;
  floor.is_ground = true;
  scenario.environment.obstacles.push_back(floor);
  return scenario;
}

/// Walks, and promises to be quicker than walking.
class BriskGait : public GaitMotion {
 public:
  BriskGait(const models::RobotModel& robot, const NominalStance& stance)
      : walking_(robot, stance, DrcHubo1Flowing("walk").motion().paces()) {}
  std::vector<Phase> Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                            const CancellationToken& cancellation) const override {
    return walking_.Motion(strides, knot_spacing, cancellation);
  }
  double ExpectedDuration(int strides) const override {
    return 0.5 * walking_.ExpectedDuration(strides);
  }

 private:
  DynamicGait walking_;
};

GaitFactory Brisk() {
  GaitFactory brisk{"brisk", "walk", DrcHubo1().GaitNamed("walk").parameters, {}};
  brisk.make = [](const models::RobotModel& robot, const NominalStance& stance) {
    return std::make_unique<BriskGait>(robot, stance);
  };
  return brisk;
}

/// Walking from rest to rest, stride by stride.
GaitFactory Plodding() {
  GaitFactory plodding = Brisk();
  plodding.make = [](const models::RobotModel& robot, const NominalStance& stance) {
    return std::make_unique<QuasiStaticGait>(robot, stance);
  };
  return plodding;
}

PlanResult PlanWith(const models::Scenario& scenario, const GaitFactory& gait) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.gaits = {gait};
  request.threads = 1;
  return PlanTraversal(DrcHubo1(), scenario, request);
}

bool Uses(const PlanResult& result, const std::string& action) {
  return std::any_of(result.plan.segments.begin(), result.plan.segments.end(),
                     [&](const Segment& segment) { return segment.action == action; });
}

double DurationOf(const PlanResult& result) {
  return result.plan.segments.back().phases.back().knots.back().t;
}

TEST(FurtherGaitTest, AGaitOfTheSameStanceThatExpectsToBeQuickerTakesTheRoute) {
  const PlanResult quick = PlanWith(Hall(), Brisk());
  ASSERT_EQ(quick.status, PlanStatus::kFound) << quick.explanation;
  EXPECT_TRUE(quick.verification.accepted());
  EXPECT_TRUE(Uses(quick, "brisk"));
}

TEST(FurtherGaitTest, WalkingFlowsRoundBendsAndIsSimulated) {
  models::Scenario near = Hall();
  near.actions = {"walk"};
  near.start.x = 0;
  near.goals.front().yaw = 0.8;
  const PlanResult result = PlanTraversal(DrcHubo1(), near, PlanRequest());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  EXPECT_FALSE(result.verification.rollouts.empty());
  const models::Gait& walk = DrcHubo1().GaitNamed("walk");
  const NominalStance stance = SolveNominalStance(DrcHubo1(), walk);
  const double strides = near.goals.front().x / walk.parameters.forward;
  EXPECT_LT(DurationOf(result),
            0.3 * QuasiStaticGait(DrcHubo1(), stance).ExpectedDuration(static_cast<int>(strides)));
}

TEST(FurtherGaitTest, ASlowerGaitOfTheSameStanceIsNotUsed) {
  const PlanResult result = PlanWith(Hall(), Plodding());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_FALSE(Uses(result, "brisk"));
}

/// Sweeps its volumes as walking does and promises to be quicker; routes get no motion from it.
class ThrowingGait : public GaitMotion {
 public:
  ThrowingGait(const models::RobotModel& robot, const NominalStance& stance)
      : walking_(robot, stance) {}
  std::vector<Phase> Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                            const CancellationToken& cancellation) const override {
    if (strides.size() > 2) throw std::runtime_error("out of ideas");
    return walking_.Motion(strides, knot_spacing, cancellation);
  }
  double ExpectedDuration(int strides) const override { return 0.1 * strides; }

 private:
  QuasiStaticGait walking_;
};

TEST(FurtherGaitTest, AGaitThatThrowsLeavesThePlanToOthers) {
  GaitFactory gait = Brisk();
  gait.make = [](const models::RobotModel& robot, const NominalStance& stance) {
    return std::make_unique<ThrowingGait>(robot, stance);
  };
  models::Scenario near = Hall();
  near.goals.front().x = near.start.x + 2;
  const PlanResult result = PlanWith(near, gait);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(Uses(result, "walk"));
  EXPECT_GT(result.plan.statistics.at("routes refuted by motion generation"), 0);
}

/// A wall across the hall: both gaits explored, neither can pass.
TEST(FurtherGaitTest, ABlockedHallIsAnsweredNoForBothGaits) {
  models::Scenario scenario = Hall();
  models::Obstacle wall;
  wall.name = "wall";
  wall.shape = models::Shape::Box({0.2, 8, 4});
  scenario.environment.obstacles.push_back(wall);
  EXPECT_EQ(PlanWith(scenario, Brisk()).status, PlanStatus::kProvenInfeasible);
}

std::string MessageOf(const GaitFactory& gait) {
  try {
    PlanWith(Hall(), gait);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FurtherGaitTest, FaultyFactoriesAreRefusedInOneLine) {
  const auto expect = [](const GaitFactory& gait, const std::string& part) {
    const std::string message = MessageOf(gait);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  GaitFactory gait = Brisk();
  gait.stance_of = "hover";
  expect(gait, "gait 'brisk' has the stance of 'hover'");
  gait = Brisk();
  gait.make = {};
  expect(gait, "the factory of gait 'brisk' is empty");
  gait.make = [](const models::RobotModel&, const NominalStance&) {
    return std::unique_ptr<GaitMotion>();
  };
  expect(gait, "'brisk' made nothing");
  gait = Brisk();
  gait.name = "crawl";
  expect(gait, "called 'crawl'");
  gait = Plodding();
  gait.parameters.forward = 3;
  expect(gait, "gaits.brisk.parameters: the stride (");
}

}  // namespace
}  // namespace possibility::actions
