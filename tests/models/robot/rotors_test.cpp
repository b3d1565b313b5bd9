#include "models/robot/rotors.h"

#include <gtest/gtest.h>

namespace possibility::models {
namespace {

TEST(RotorsTest, OneJointWithARotorIsEnough) {
  RobotModel robot;
  EXPECT_FALSE(HasRotors(robot));
  robot.joints.resize(3);
  robot.joints[0].actuator.viscous_friction = 1;
  EXPECT_FALSE(HasRotors(robot));
  robot.joints[2].actuator.armature = 0.1;
  EXPECT_TRUE(HasRotors(robot));
}

}  // namespace
}  // namespace possibility::models
