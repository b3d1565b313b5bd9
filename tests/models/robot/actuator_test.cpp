#include "models/robot/actuator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

Actuator Geared() {
  Actuator actuator;
  actuator.armature = 0.3;
  actuator.viscous_friction = 1.5;
  actuator.dry_friction = 4;
  actuator.dry_speed = 0.2;
  actuator.line = TorqueSpeedLine{120, 8};
  return actuator;
}

TEST(ActuatorTest, FrictionOpposesMotionAndItsDerivativesAgreeWithDifferences) {
  const Actuator actuator = Geared();
  constexpr double kStep = 1e-5;
  for (double speed = -2; speed <= 2; speed += 0.013) {
    EXPECT_GE(actuator.Friction(speed) * speed, 0);
    EXPECT_EQ(actuator.Friction(-speed), -actuator.Friction(speed));
    const double slope =
        (actuator.Friction(speed + kStep) - actuator.Friction(speed - kStep)) / (2 * kStep);
    EXPECT_NEAR(actuator.FrictionSlope(speed), slope, 1e-6);
    const double curvature =
        (actuator.FrictionSlope(speed + kStep) - actuator.FrictionSlope(speed - kStep)) /
        (2 * kStep);
    EXPECT_NEAR(actuator.FrictionCurvature(speed), curvature, 1e-5);
    EXPECT_LE(std::abs(actuator.FrictionCurvature(speed)), actuator.GreatestFrictionCurvature());
  }
  EXPECT_NEAR(actuator.Friction(0.2), 1.5 * 0.2 + 4 * 0.7616, 1e-3);
  // At 0.66 dry_speed the curvature is greatest.
  EXPECT_NEAR(std::abs(actuator.FrictionCurvature(0.2 * std::atanh(1 / std::sqrt(3.0)))),
              actuator.GreatestFrictionCurvature(), 1e-9);
}

TEST(ActuatorTest, TheLineLimitsDrivingTorquesAndLeavesBrakingOnes) {
  const Actuator actuator = Geared();
  EXPECT_EQ(actuator.Limit(90, 1, 0), 90);
  EXPECT_DOUBLE_EQ(actuator.Limit(90, 1, 4), 60);
  EXPECT_DOUBLE_EQ(actuator.Limit(90, -1, -4), 60);
  EXPECT_EQ(actuator.Limit(90, -1, 4), 90);
  EXPECT_EQ(actuator.Limit(90, 1, 8), 0);
  EXPECT_EQ(actuator.Limit(90, 1, 20), 0);
  EXPECT_DOUBLE_EQ(actuator.Limit(90, -6), 30);
  EXPECT_EQ(Actuator().Limit(90, 1, 1e6), 90);
  EXPECT_FALSE(Actuator().HasLosses());
}

TEST(ActuatorTest, IsReadForTheJointsThatAreNamed) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", TwoLeggedUrdf());
  const RobotModel robot = LoadRobotModel(folder.Write(
      "robot.yaml",
      Replaced(TwoLeggedYaml(), "shapes:",
               "actuators:\n"
               "  - {joints: [l_yaw, r_yaw], armature: 0.3, viscous_friction: 1.5, reason: a}\n"
               "  - {joints: [l_slide], dry_friction: 4, dry_speed: 0.2, reason: b}\n"
               "  - {joints: [r_slide], stall_torque: 120, no_load_speed: 8, reason: c}\n"
               "shapes:")));
  const auto actuator = [&](const char* joint) {
    return robot.joints[robot.JointIndex(joint)].actuator;
  };
  EXPECT_EQ(actuator("r_yaw").armature, 0.3);
  EXPECT_EQ(actuator("l_yaw").viscous_friction, 1.5);
  EXPECT_FALSE(actuator("l_yaw").line);
  EXPECT_EQ(actuator("l_slide").dry_friction, 4);
  EXPECT_EQ(actuator("l_slide").dry_speed, 0.2);
  EXPECT_EQ(actuator("r_slide").line->stall_torque, 120);
  EXPECT_EQ(actuator("r_slide").line->no_load_speed, 8);
  EXPECT_FALSE(actuator("l_roll").HasLosses());
  EXPECT_EQ(robot.LegJoints().size(), 6u);
}

TEST(ActuatorTest, AMimicJointHasNone) {
  const TemporaryFolder folder;
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" velocity=\"5\" effort=\"50\"/>";
  folder.Write("robot.urdf", Replaced(TwoLeggedUrdf(), limit, limit + "<mimic joint=\"r_yaw\"/>"));
  const auto yaml = folder.Write(
      "robot.yaml",
      Replaced(Replaced(TwoLeggedYaml(), "[l_yaw, r_yaw], limit", "[r_yaw], limit"),
               "shapes:", "actuators: [{joints: [l_yaw], armature: 0.3, reason: a}]\nshapes:"));
  EXPECT_NE(MessageOf<InputError>([&] { LoadRobotModel(yaml); })
                .find("robot.yaml:8: actuators[0].joints: joint 'l_yaw' mimics 'r_yaw', whose "
                      "actuator counts for both"),
            std::string::npos);
}

}  // namespace
}  // namespace possibility::models
