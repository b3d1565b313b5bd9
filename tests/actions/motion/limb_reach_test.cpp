#include "actions/motion/limb_reach.h"

#include <gtest/gtest.h>

#include "actions/motion/limb_bend.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

TEST(LimbReachTest, ALegBendsInItsKnee) {
  const models::RobotModel& robot = DrcHubo1();
  const models::Gait& walk = robot.GaitNamed("walk");
  EXPECT_EQ(BendOf(robot, walk.limbs[0])->name, "LKP");
  EXPECT_EQ(BendOf(robot, walk.limbs[1])->name, "RKP");
}

/// With the knee straight, hip over ankle, the root is as high as reach says.
TEST(LimbReachTest, TheRootIsHighestOverAStraightLeg) {
  const models::RobotModel& robot = DrcHubo1();
  const NominalStance stance = SolveNominalStance(robot, robot.GaitNamed("walk"));
  const auto reaches = ReachesOf(robot, stance, 1);
  dynamics::TreeKinematics kinematics(robot);
  Eigen::VectorXd q = stance.q;
  for (const char* joint : {"LHP", "LKP", "LAP"}) q[7 + robot.JointIndex(joint)] = 0;
  kinematics.SetPosition(q);
  const models::ContactPatch& sole = robot.contacts[robot.ContactIndex("left_sole")];
  const Eigen::Vector3d centre = kinematics.Position(sole.link, sole.Centre());
  ASSERT_TRUE(reaches[0]);
  const auto highest = reaches[0]->HighestRoot({}, centre, Eigen::Matrix3d::Identity());
  ASSERT_TRUE(highest);
  EXPECT_NEAR(*highest, q[6], 1e-3);  // the knee is a little off the line from hip to ankle
}

TEST(LimbReachTest, WhatIsFartherAwayThanTheLimbIsLongIsOutOfReach) {
  const models::RobotModel& robot = DrcHubo1();
  const NominalStance stance = SolveNominalStance(robot, robot.GaitNamed("walk"));
  for (const auto& reach : ReachesOf(robot, stance, 1)) {
    ASSERT_TRUE(reach);
    EXPECT_FALSE(reach->HighestRoot({}, {1.5, 0, 0}, Eigen::Matrix3d::Identity()));
    EXPECT_TRUE(reach->HighestRoot({}, {0.3, 0, 0}, Eigen::Matrix3d::Identity()));
  }
}

}  // namespace
}  // namespace possibility::actions
