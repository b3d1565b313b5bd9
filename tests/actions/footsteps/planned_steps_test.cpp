#include "actions/footsteps/planned_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "actions/planner/planner.h"
#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"
#include "tests/actions/footsteps/uneven_world.h"
#include "tests/actions/geared_drchubo1.h"

namespace possibility::actions {
namespace {

class PlannedStepsTest : public ::testing::Test {
 protected:
  PlannedSteps& StepsIn(UnevenWorld* world, const LocomotionModel& model = WalkingHubo()) {
    PlanningContext context;
    context.model = &model;
    context.world = world->Built();
    context.space = std::make_shared<PelvisPoseSpace>(world->environment.bounds,
                                                      world->ground->levels(), 0.137);
    context.gaits = {
        std::make_shared<QuasiStaticAction>(model, 0, world->world, context.space, 0.25)};
    return *(steps_ = std::make_unique<PlannedSteps>(context, 0));
  }

  static graph::Edge EdgeOf(const GroundedStance& from, const GroundedStance& to) {
    const NominalStance& stance = WalkingHubo().gaits[0]->stance;
    return {ToPoint(stance.RootPose(from.pose, from.z)), ToPoint(stance.RootPose(to.pose, to.z))};
  }

  std::unique_ptr<PlannedSteps> steps_;
};

TEST_F(PlannedStepsTest, MotionLeadsFromRestToRestBetweenTheStances) {
  UnevenWorld world;
  world.Ground(-3, 0.3, 0).Ground(0.3, 4, 0.08);
  const PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.2), UnevenWorld::StanceAt(1, 0.08));
  ASSERT_TRUE(steps.CN(edge));
  const std::vector<Phase> motion = steps.Motion(edge, {});
  const Knot& last = motion.back().knots.back();
  EXPECT_LT((ToPoint(Eigen::Translation3d(last.q.segment<3>(4)) *
                     Eigen::Quaterniond(last.q[0], last.q[1], last.q[2], last.q[3])) -
             edge.to)
                .norm(),
            1e-6);
  EXPECT_LT(last.v.norm() + motion.front().knots.front().v.norm(), 1e-6);
  EXPECT_EQ(steps.plan_action(), "walk");
}

/// The first footholds are too far from each other: with one foot 0.30 m behind and 0.15 m below
/// the other, the knee needs more than 100 N m.
TEST_F(PlannedStepsTest, AFlightOfHighStepsIsClimbedWithBothFeetOnEachTread) {
  UnevenWorld world;
  world.Ground(-3, 0.3, 0).Ground(0.3, 0.6, 0.15, 1).Ground(0.6, 0.9, 0.3, 1).Ground(0.9, 4, 0.45);
  const PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.4), UnevenWorld::StanceAt(1.6, 0.45));
  ASSERT_TRUE(steps.CN(edge));
  const Knot last = steps.Motion(edge, {}).back().knots.back();
  EXPECT_NEAR(last.q[6], edge.to[2], 1e-6);
}

/// The greatest share of a joint's torque.
double TorqueUsed(const std::vector<Phase>& motion) {
  double used = 0;
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      for (int j = 0; j < DrcHubo1().num_joints(); ++j) {
        used = std::max(used, std::abs(knot.tau[j]) / DrcHubo1().joints[j].effort);
      }
    }
  }
  return used;
}

double TorqueUsedOnStairs(const models::RobotModel& robot) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  models::Scenario stairs = ShippedScenario("stairs");
  stairs.robot_hash = robot.content_hash;
  const PlanResult result = PlanTraversal(robot, stairs, request);
  EXPECT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  double used = 0;
  for (const Segment& segment : result.plan.segments) {
    used = std::max(used, TorqueUsed(segment.phases));
  }
  return used;
}

TEST(SparingSteps, OfAGearedRobotClimbStairsWithLessTorque) {
  EXPECT_GT(TorqueUsedOnStairs(DrcHubo1()), 0.86);
  EXPECT_LE(TorqueUsedOnStairs(GearedDrcHubo1()), 0.85 + 1e-9);
}

/// Four sequences of footholds need more than 85 % of the torque.
TEST_F(PlannedStepsTest, AGearedRobotUsesMoreTorqueWhereItFindsNoSparingSteps) {
  const LocomotionModel geared =
      BuildLocomotionModel(GearedDrcHubo1(), {"walk"}, {}, DrcHubo1Library());
  UnevenWorld world;
  world.Ground(-3, 0.3, 0).Ground(0.3, 4, 0.16);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.2), UnevenWorld::StanceAt(1, 0.16));
  EXPECT_GT(TorqueUsed(StepsIn(&world, geared).Motion(edge, {})), 0.85);
}

TEST_F(PlannedStepsTest, TheSameEdgeHasTheSameMotion) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.05, 4, 0);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(0.8));
  const Knot first = StepsIn(&world).Motion(edge, {}).back().knots.back();
  const Knot second = StepsIn(&world).Motion(edge, {}).back().knots.back();
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.t, second.t);
}

/// Jobs do not test these motions again.
TEST_F(PlannedStepsTest, MotionKeepsOffObstaclesAndTheRobotItself) {
  UnevenWorld world;
  world.Ground(-3, 0.3, 0).Ground(0.3, 4, 0.1).Box({0.06, 3, 0.08}, {-0.6, 0, 0.04});
  const PlannedSteps& steps = StepsIn(&world);
  EXPECT_TRUE(steps.TestsItsMotions());
  const std::vector<Phase> motion =
      steps.Motion(EdgeOf(UnevenWorld::StanceAt(-1.3), UnevenWorld::StanceAt(1.2, 0.1)), {});
  const models::CollisionChecker checker(DrcHubo1(), world.environment);
  EXPECT_EQ(FirstHit(DrcHubo1(), world.environment, checker, motion), "");
  EXPECT_EQ(FirstSelfHit(DrcHubo1(), checker, motion), "");
}

class SuggestedSteps : public PlannedStepsTest {
 protected:
  /// Equal strides over level ground from x = 0 on, and a last step that brings both feet beside
  /// each other.
  static std::vector<Footstep> Strides(int count, double length) {
    std::vector<Footstep> steps;
    std::array<Foothold, 2> feet;
    for (int i = 1; i <= count + 1; ++i) {
      const int limb = i % 2;
      Foothold place = feet[limb];
      place.stance.x = std::min(i, count) * length;
      steps.push_back({limb, feet[limb], place, 0});
      feet[limb] = place;
    }
    return steps;
  }

  static int SwingsIn(const std::vector<Phase>& motion) {
    return static_cast<int>(std::count_if(motion.begin(), motion.end(), [](const Phase& phase) {
      return phase.contacts.size() == 1;
    }));
  }
};

TEST_F(SuggestedSteps, AreTaken) {
  UnevenWorld world;
  world.Ground(-3, 4, 0);
  const PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(0), UnevenWorld::StanceAt(9 * 0.1));
  steps.Suggest(edge, Strides(9, 0.1));
  EXPECT_EQ(SwingsIn(steps.Motion(edge, {})), 10);
  EXPECT_LT(SwingsIn(StepsIn(&world).Motion(edge, {})), 10) << "a search takes longer strides";
}

TEST_F(SuggestedSteps, AreAsLongAsExpected) {
  UnevenWorld world;
  world.Ground(-3, 4, 0);
  const PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(0), UnevenWorld::StanceAt(0.9));
  const double unknown = steps.ExpectedDuration(edge);
  steps.Suggest(edge, Strides(9, 0.1));
  const double duration = steps.Motion(edge, {}).back().knots.back().t;
  EXPECT_NEAR(steps.ExpectedDuration(edge), duration, 1e-9);
  EXPECT_NE(unknown, steps.ExpectedDuration(edge));
}

TEST_F(SuggestedSteps, BelongToEdgesWhoseEndsDifferByRounding) {
  UnevenWorld world;
  world.Ground(-3, 4, 0);
  const PlannedSteps& steps = StepsIn(&world);
  graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(0), UnevenWorld::StanceAt(9 * 0.1));
  steps.Suggest(edge, Strides(9, 0.1));
  edge.to[0] += 1e-12;
  EXPECT_EQ(SwingsIn(steps.Motion(edge, {})), 10);
}

TEST_F(SuggestedSteps, BeyondTheRobotAreReplacedByASearch) {
  UnevenWorld world;
  world.Ground(-3, 4, 0);
  const PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(0), UnevenWorld::StanceAt(1.2));
  const std::vector<Footstep> leaps = Strides(2, 0.6);
  steps.Suggest(edge, leaps);
  EXPECT_GT(SwingsIn(steps.Motion(edge, {})), static_cast<int>(leaps.size()));
}

TEST_F(PlannedStepsTest, WithoutFootholdsThereIsNoMotion) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.8, 4, 0);
  EXPECT_THROW(
      StepsIn(&world).Motion(EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(1.5)), {}),
      MotionError);
}

TEST_F(PlannedStepsTest, WhatAProofRefusesIsNotAskedAgain) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.8, 4, 0);
  PlannedSteps& steps = StepsIn(&world);
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(1.5));
  EXPECT_THROW(steps.Motion(edge, {}), MotionError);
  std::vector<graph::Edge> edges;
  EXPECT_FALSE(steps.AskAgain(&edges));
  EXPECT_EQ(steps.doublings(), 0);
}

/// Without bounds nothing can be proved.
TEST_F(PlannedStepsTest, WhatFailsWithoutAProofIsAskedAgainWithTwiceTheEffort) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.8, 4, 0);
  PlannedSteps& steps = StepsIn(&world);
  world.environment.bounds.setEmpty();
  const graph::Edge edge = EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(1.5));
  EXPECT_THROW(steps.Motion(edge, {}), MotionError);
  std::vector<graph::Edge> edges;
  ASSERT_TRUE(steps.AskAgain(&edges));
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges[0].from, edge.from);
  EXPECT_EQ(edges[0].to, edge.to);
  EXPECT_EQ(steps.doublings(), 1);
  EXPECT_THROW(steps.Motion(edge, {}), MotionError);
  EXPECT_FALSE(steps.AskAgain(&edges)) << "the effort is limited";
}

TEST_F(PlannedStepsTest, WhatIsFoundIsNotAskedAgain) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.05, 4, 0);
  PlannedSteps& steps = StepsIn(&world);
  steps.Motion(EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(0.8)), {});
  std::vector<graph::Edge> edges;
  EXPECT_FALSE(steps.AskAgain(&edges));
  steps.OnCutShort();
  EXPECT_TRUE(steps.AskAgain(&edges)) << "an explorer's search was cut short";
  EXPECT_TRUE(edges.empty());
}

TEST_F(PlannedStepsTest, CancellationEndsTheJob) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.05, 4, 0);
  EXPECT_THROW(
      StepsIn(&world).Motion(EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(0.8)),
                             CancellationToken([] { return false; })),
      Cancelled);
}

TEST_F(PlannedStepsTest, AnEdgeNeedsStancesThatMeetCS) {
  UnevenWorld world;
  world.Ground(-3, 0, 0).Ground(0.05, 4, 0);
  const PlannedSteps& steps = StepsIn(&world);
  EXPECT_FALSE(steps.CN(EdgeOf(UnevenWorld::StanceAt(-0.5), UnevenWorld::StanceAt(0.1))));
}

class UnevenScenes : public ::testing::TestWithParam<const char*> {
 protected:
  static PlanResult PlanOf(const std::string& scene) {
    PlanRequest request;
    request.library = DrcHubo1Library();
    return PlanTraversal(DrcHubo1(), ShippedScenario(scene), request);
  }
};

TEST_P(UnevenScenes, AreWalkedByPlannedSteps) {
  const PlanResult result = PlanOf(GetParam());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  ASSERT_TRUE(result.plan.search);
  EXPECT_EQ(result.plan.search->explorers.front(), "footsteps");
  for (const Segment& segment : result.plan.segments) EXPECT_EQ(segment.action, "walk");
}

INSTANTIATE_TEST_SUITE_P(Shipped, UnevenScenes,
                         ::testing::Values("crack", "sill", "stones", "stairs", "ramp", "debris",
                                           "height_map", "rubble"));

TEST(UnevenScenesAlone, FootstepsNeedNoOtherExplorer) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.explorers = {"footsteps"};
  const PlanResult result = PlanTraversal(DrcHubo1(), ShippedScenario("crack"), request);
  EXPECT_EQ(result.status, PlanStatus::kFound) << result.explanation;
}

class UnevenTwins : public UnevenScenes {};

TEST_P(UnevenTwins, AreExhausted) {
  const PlanResult result = PlanOf(GetParam());
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
}

INSTANTIATE_TEST_SUITE_P(Shipped, UnevenTwins,
                         ::testing::Values("crack_infeasible", "sill_infeasible",
                                           "stones_infeasible", "stairs_infeasible",
                                           "ramp_infeasible", "debris_infeasible",
                                           "doorway_infeasible", "rubble_infeasible"));

}  // namespace
}  // namespace possibility::actions
