#include "actions/footsteps/sideways_load.h"

#include <gtest/gtest.h>

#include "tests/actions/drchubo1.h"
#include "tests/actions/shipped_robots.h"

namespace possibility::actions {
namespace {

TEST(SidewaysLoadTest, IsTheWeightTimesTheHipsDistanceOverItsTorque) {
  models::RobotModel robot = DrcHubo1();
  const NominalStance stance = SolveNominalStance(robot, robot.GaitNamed("walk"));
  const double load = SidewaysLoad(robot, stance);
  EXPECT_GT(load, 0);
  // Half the torque, twice the load.
  for (models::Joint& joint : robot.joints) joint.effort /= 2;
  EXPECT_NEAR(SidewaysLoad(robot, stance), 2 * load, 1e-12);
  // Twice the mass, twice the load.
  for (models::Link& link : robot.links) link.inertial.mass *= 2;
  EXPECT_NEAR(SidewaysLoad(robot, stance), 4 * load, 1e-12);
}

/// T1 needs nearly all of its hips' torque to stand on one leg; the others do not.
TEST(SidewaysLoadTest, TellsT1FromTheOthers) {
  const auto load = [](const models::RobotModel& robot, const LocomotionModel& model) {
    return SidewaysLoad(robot, model.gaits[0]->stance);
  };
  EXPECT_GT(load(RobotNamed("t1").robot(), RobotNamed("t1").model()), 0.85);
  EXPECT_LT(load(RobotNamed("h1_2").robot(), RobotNamed("h1_2").model()), 0.6);
  EXPECT_LT(load(DrcHubo1(), DrcHubo1Locomotion()), 0.6);
}

}  // namespace
}  // namespace possibility::actions
