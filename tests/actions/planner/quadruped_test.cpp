// A robot that bears on points alone: what is possible for it, and that no proof is false.

#include "tests/actions/quadruped.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/flood/flood_oracle.h"
#include "actions/flood/necessary_flood.h"
#include "actions/flood/route_flood.h"
#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/planner/leg_scene.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

using graph::RouteOracleAnswer;

/// A floor with a wall across it, in which there is a door `width` wide.
models::Environment DoorEnvironment(double width) {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -1.5), Eigen::Vector2d(2, 1.5));
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({6, 5, 0.2});
  floor.X_WO.translation().z() = -0.1;
  floor.is_ground = true;
  environment.obstacles = {floor};
  for (const int side : {-1, 1}) {
    models::Obstacle wall;
    wall.name = side < 0 ? "right_wall" : "left_wall";
    wall.shape = models::Shape::Box({0.2, 2.5 - width / 2, 1});
    wall.X_WO.translation() << 0, side * (2.5 + width / 2) / 2, 0.5;
    environment.obstacles.push_back(wall);
  }
  return environment;
}

models::Scenario QuadrupedDoor(double width) {
  models::Scenario scenario;
  scenario.name = scenario.file = "door.yaml";
  scenario.robot_file = Quadruped().file;
  scenario.actions = {"walk"};
  scenario.start = {"walk", -1.2, -0.4, 0, 0.5};
  scenario.goals = {{"walk", 1.2, 0.3, 0, -0.4}};
  scenario.environment = DoorEnvironment(width);
  return scenario;
}

RouteLeg RandomLeg(std::mt19937* generator, double extent) {
  std::uniform_real_distribution<double> unit(-1, 1);
  RouteLeg leg;
  leg.from = RandomStance(generator, extent);
  leg.to =
      leg.from * PlanarPose{0.4 * unit(*generator), 0.2 * unit(*generator), 0.4 * unit(*generator)};
  return leg;
}

/// The floods must let through every leg that the verifier accepts.
void ExpectNoProofAgainst(const LegScene& scene, const RouteLeg& leg) {
  const GroundedStance from{0, leg.from, 0};
  const std::vector<GroundedStance> goals = {{0, leg.to, 0}};
  EXPECT_TRUE(
      FloodNecessary(QuadrupedLocomotion(), scene.world(), from, goals, 0.1).route_may_exist);
}

void ExpectSufficientIsVerifiedIsNecessary(int count, unsigned seed) {
  const LocomotionModel& model = QuadrupedLocomotion();
  std::mt19937 generator(seed);
  int sufficient = 0, beyond_sufficient = 0;
  while (sufficient < count || beyond_sufficient == 0) {
    const LegScene scene(model, RandomEnvironment(&generator, 30));
    const QuasiStaticAction& action = scene.action(0);
    for (int attempt = 0; attempt < 20; ++attempt) {
      const RouteLeg leg = RandomLeg(&generator, 2.5);
      const graph::Edge edge = LegEdge(model, leg);
      const bool is_sufficient = action.CS(edge);
      const VerificationReport report = scene.VerifyLeg(leg);
      if (is_sufficient) {
        ASSERT_TRUE(report.accepted()) << FormatText(report);
      }
      if (!report.accepted()) continue;
      EXPECT_TRUE(action.CN(edge));
      EXPECT_TRUE(action.CN(edge.from));
      EXPECT_TRUE(action.CN(edge.to));
      ExpectNoProofAgainst(scene, leg);
      ++(is_sufficient ? sufficient : beyond_sufficient);
    }
  }
}

TEST(Quadruped, PointFeetStandOnlyWithinReachOfTheGround) {
  const LegScene scene(QuadrupedLocomotion(), DoorEnvironment(1));
  const NominalStance& stance = QuadrupedLocomotion().gaits[0]->stance;
  EXPECT_TRUE(scene.action(0).CN(ToPoint(stance.RootPose({-1, 0, 0.3}, 0))));
  // A leg is 0.07 m of hip and 0.44 m of thigh and shank, 0.24 m from the trunk's middle.
  EXPECT_NEAR(BearingReach(Quadruped(), Quadruped().gaits[0]), 0.07 + 0.44 + 0.2417, 1e-3);
  EXPECT_FALSE(scene.action(0).CN(ToPoint(stance.RootPose({-1, 0, 0.3}, 1))));
}

TEST(Quadruped, SufficientLegsVerifyAndVerifiedLegsAreNecessary) {
  ExpectSufficientIsVerifiedIsNecessary(4, 1);
}
TEST(QuadrupedLong, SufficientLegsVerifyAndVerifiedLegsAreNecessary) {
  ExpectSufficientIsVerifiedIsNecessary(80, 2);
}

TEST(Quadruped, OnlyADoorTooNarrowForTheTrunkIsProvenInfeasible) {
  const auto ask = [](double width) {
    const LegScene scene(QuadrupedLocomotion(), DoorEnvironment(width));
    const std::vector<std::shared_ptr<Manoeuvre>> nothing_else;
    return FloodOracle(QuadrupedLocomotion(), scene.world(), nothing_else, 0.1, {})
        .Ask({0, {-1.2, 0, 0}, 0}, {{0, {1.2, 0, 0}, 0}});
  };
  EXPECT_EQ(ask(1), RouteOracleAnswer::kUnknown);
  // The feet are too far apart for the door, the trunk is not too wide.
  EXPECT_EQ(ask(0.25), RouteOracleAnswer::kExhausted);
  EXPECT_EQ(ask(0.05), RouteOracleAnswer::kProvenInfeasible);
}

/// A way that only needs a trunk carried at its nominal height must not be called impossible.
TEST(Quadruped, ASillBelowTheTrunkIsNotProvenInfeasible) {
  models::Environment environment = DoorEnvironment(1);
  models::Obstacle sill;
  sill.name = "sill";
  sill.shape = models::Shape::Box({0.05, 1, 0.2});
  sill.X_WO.translation().z() = 0.1;
  environment.obstacles.push_back(sill);
  const LegScene scene(QuadrupedLocomotion(), environment);
  const FloodResult flood = FloodNecessary(QuadrupedLocomotion(), scene.world(),
                                           {0, {-1.2, 0, 0}, 0}, {{0, {1.2, 0, 0}, 0}}, 0.1);
  EXPECT_TRUE(flood.route_may_exist);
}

TEST(Quadruped, WalksThroughADoor) {
  PlanRequest request;
  request.time_limit = 1000;  // sanitizers are slow
  const PlanResult result = PlanTraversal(Quadruped(), QuadrupedDoor(1), request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
}

}  // namespace
}  // namespace possibility::actions
