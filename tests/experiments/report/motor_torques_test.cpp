#include "experiments/report/motor_torques.h"

#include <gtest/gtest.h>

namespace possibility::experiments {
namespace {

using Eigen::VectorXd;

TEST(MotorTorques, OfMimicsActThroughTheirMasters) {
  models::RobotModel robot;
  robot.joints.resize(4);
  robot.joints[0].mimic = {2, -0.5, 0};
  robot.joints[3].mimic = {2, 2, 0.1};
  const VectorXd motors = MotorTorques(robot, Eigen::Vector4d(10, 20, 30, 40));
  EXPECT_EQ(motors, (VectorXd(4) << 0, 20, 30 - 5 + 80, 0).finished());
}

}  // namespace
}  // namespace possibility::experiments
