#include "actions/gait/waist_joint.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

std::optional<Waist> WaistOf(const models::RobotModel& robot, const std::string& gait) {
  return WaistJoint(robot, SolveNominalStance(robot, robot.GaitNamed(gait)));
}

TEST(WaistJointTest, IsTheOneThatCarriesTheTrunk) {
  const std::string models = std::string(POSSIBILITY_SOURCE_DIR) + "/models/";
  for (const auto& [file, joint] :
       {std::pair("drchubo1/drchubo1.yaml", "TSY"), std::pair("h1_2/h1_2.yaml", "torso_joint"),
        std::pair("t1/t1.yaml", "Waist")}) {
    const models::RobotModel robot = models::LoadRobotModel(models + file);
    const std::optional<Waist> waist = WaistOf(robot, "walk");
    ASSERT_TRUE(waist) << file;
    EXPECT_EQ(robot.joints[waist->joint].name, joint);
    EXPECT_EQ(waist->sign, 1);
  }
}

TEST(WaistJointTest, SaysWhetherItsAxisPointsUp) {
  models::RobotModel robot = DrcHubo1();
  robot.joints[robot.JointIndex("TSY")].axis *= -1;
  EXPECT_EQ(WaistOf(robot, "walk")->sign, -1);
}

TEST(WaistJointTest, IsNoneIfNoJointIsUprightAndCarriesMuch) {
  models::RobotModel tilted = DrcHubo1();
  tilted.joints[tilted.JointIndex("TSY")].axis = Eigen::Vector3d::UnitX();
  EXPECT_FALSE(WaistOf(tilted, "walk"));
  // Lying back, its axis is not vertical.
  EXPECT_FALSE(WaistOf(DrcHubo1(), "crawl"));
}

}  // namespace
}  // namespace possibility::actions
