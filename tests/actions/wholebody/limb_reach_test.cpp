#include "actions/wholebody/limb_reach.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "actions/wholebody/limb_bend.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/shipped_robots.h"

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

/// A URDF may put a joint anywhere on its axis.
TEST(LimbReachTest, AKneeElsewhereOnItsAxisIsTheSameKnee) {
  for (const char* name : {"drchubo1", "t1", "h1_2"}) {
    models::RobotModel robot = RobotNamed(name).robot();
    const models::GaitLimb leg = robot.GaitNamed("walk").limbs[0];
    const LimbBend before = *BendOf(robot, leg);
    models::Joint& knee = robot.joints[leg.joints[before.joint]];
    models::Joint& ankle = robot.joints[leg.joints[before.joint + 1]];
    const Eigen::Vector3d along = 0.05 * knee.axis;
    knee.X_PJ.translation() += knee.X_PJ.linear() * along;
    ankle.X_PJ.translation() -= along;
    const std::optional<LimbBend> bend = BendOf(robot, leg);
    ASSERT_TRUE(bend) << name;
    EXPECT_EQ(bend->name, before.name) << name;
    EXPECT_EQ(bend->before, before.before) << name;
    EXPECT_EQ(bend->after, before.after) << name;
    EXPECT_NEAR(bend->length, before.length, 1e-3) << name;
  }
}

/// Over random angles, and with the knee straight.
TEST(LimbReachTest, TheLengthIsTheGreatestDistanceOfHipAndAnkle) {
  std::mt19937_64 random(5);
  for (const std::string& name : ShippedRobotNames()) {
    const models::RobotModel& robot = RobotNamed(name).robot();
    dynamics::TreeKinematics kinematics(robot);
    const models::GaitLimb& leg = robot.GaitNamed("walk").limbs[0];
    const LimbBend bend = *BendOf(robot, leg);
    double greatest = 0;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.nq());
    q[0] = 1;
    const auto look = [&] {
      kinematics.SetPosition(q);
      const Eigen::Vector3d hip = kinematics.X_WL()[bend.before].translation();
      const double distance = (kinematics.Position(bend.after, bend.end) - hip).norm();
      EXPECT_LT(distance, bend.length + 2e-3) << name;
      greatest = std::max(greatest, distance);
    };
    for (int i = 0; i < 2000; ++i) {
      for (const int joint : leg.joints) {
        q[7 + joint] = std::uniform_real_distribution(-1.5, 1.5)(random);
      }
      look();
    }
    for (double angle = -3; angle <= 3; angle += 0.002) {
      q[7 + leg.joints[bend.joint]] = angle;
      look();
    }
    EXPECT_NEAR(greatest, bend.length, 2e-3) << name;
  }
}

/// T1's hips have their twist below, in the thigh: it begins at the joint above.
TEST(LimbReachTest, AThighBeginsAboveItsTwist) {
  const models::RobotModel& robot = RobotNamed("t1").robot();
  const models::GaitLimb& leg = robot.GaitNamed("walk").limbs[0];
  const std::optional<LimbBend> bend = BendOf(robot, leg);
  ASSERT_TRUE(bend);
  EXPECT_EQ(bend->name, "Left_Knee_Pitch");
  EXPECT_EQ(robot.joints[bend->before - 1].name, "Left_Hip_Roll");
  Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.nq());
  q[0] = 1;
  dynamics::TreeKinematics kinematics(robot);
  for (const double twist : {0.0, 0.8}) {
    q[7 + robot.JointIndex("Left_Hip_Yaw")] = twist;
    kinematics.SetPosition(q);
    const auto origin = [&](int link) -> Eigen::Vector3d {
      return kinematics.X_WL()[link].translation();
    };
    const int knee = leg.joints[bend->joint] + 1;
    EXPECT_NEAR(
        (origin(knee) - origin(bend->before)).norm() + (origin(bend->after) - origin(knee)).norm(),
        bend->length, 1e-6);
  }
}

/// A shank that ends in a point foot: the bend is the limb's last joint, and its range does not let
/// the leg be straight.
TEST(LimbReachTest, ALegOnAPointFootIsAsLongAsItsKneeLets) {
  const models::RobotModel& robot = RobotNamed("a1").robot();
  const NominalStance stance = SolveNominalStance(robot, robot.GaitNamed("walk"));
  const auto reaches = ReachesOf(robot, stance, 1);
  dynamics::TreeKinematics kinematics(robot);
  std::mt19937 generator(3);
  for (std::size_t limb = 0; limb < reaches.size(); ++limb) {
    const models::GaitLimb& leg = stance.gait->limbs[limb];
    const std::optional<LimbBend> bend = BendOf(robot, leg);
    ASSERT_TRUE(bend);
    ASSERT_TRUE(reaches[limb]);
    EXPECT_EQ(bend->joint, 2U);
    const models::ContactPatch& foot = robot.contacts[leg.contact];
    double farthest = 0;
    for (int trial = 0; trial < 300; ++trial) {
      Eigen::VectorXd q = stance.q;
      for (const int joint : leg.joints) {
        std::uniform_real_distribution<double> range(robot.joints[joint].lower,
                                                     robot.joints[joint].upper);
        q[7 + joint] = range(generator);
      }
      kinematics.SetPosition(q);
      const Eigen::Vector3d hip = kinematics.X_WL()[bend->before].translation();
      farthest = std::max(farthest, (kinematics.Position(foot.link, foot.Centre()) - hip).norm());
    }
    EXPECT_NEAR(reaches[limb]->length, farthest, 0.01);
    EXPECT_LT(reaches[limb]->length, 0.92 * bend->length);
  }
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
