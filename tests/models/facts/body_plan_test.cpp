#include "models/facts/body_plan.h"

#include <gtest/gtest.h>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/message_of.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

const std::string kHuboFolder = std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/";

UrdfTree HuboTree() {
  return ParseUrdf(ReadFileContents(kHuboFolder + "drchubo1.urdf"), "drchubo1.urdf");
}

// The YAML of DRC-HUBO1 was written by hand.
TEST(BodyPlanTest, FindsTheLimbsOfDrcHubo1) {
  const BodyPlan plan = FindBodyPlan(HuboTree(), "drchubo1.urdf");
  const RobotModel robot = LoadRobotModel(kHuboFolder + "drchubo1.yaml");
  for (const GaitLimb& limb : robot.GaitNamed("walk").limbs) {
    std::vector<std::string> names;
    for (const int joint : limb.joints) names.push_back(robot.joints[joint].name);
    const bool is_left = robot.contacts[limb.contact].name == "left_sole";
    EXPECT_EQ((is_left ? plan.left_leg : plan.right_leg).joints, names);
  }
  EXPECT_EQ(plan.left_arm.joints,
            (std::vector<std::string>{"LSP", "LSR", "LSY", "LEP", "LWY", "LWP", "LWR"}));
  EXPECT_EQ(plan.right_arm.joints,
            (std::vector<std::string>{"RSP", "RSR", "RSY", "REP", "RWY", "RWP", "RWR"}));
  EXPECT_EQ(plan.trunk, std::vector<std::string>{"TSY"});
}

TEST(BodyPlanTest, WhatTheHandWrittenFileLumpsIsLumped) {
  const UrdfTree tree = HuboTree();
  const BodyPlan plan = FindBodyPlan(tree, "drchubo1.urdf");
  const RobotModel robot = LoadRobotModel(kHuboFolder + "drchubo1.yaml");
  std::set<std::string> kept;
  for (const Joint& joint : robot.joints) kept.insert(joint.name);
  for (const UrdfJoint& joint : tree.joints) {
    if (joint.type == "fixed") continue;
    EXPECT_NE(plan.lump.contains(joint.name), kept.contains(joint.name)) << joint.name;
  }
}

TEST(BodyPlanTest, LegsOfFewJointsAreNamed) {
  EXPECT_EQ(
      MessageOf<InputError>(
          [] { FindBodyPlan(ParseUrdf(TwoLeggedUrdf(), "robot.urdf"), "robot.urdf"); }),
      "robot.urdf: the legs that end in 'l_slide' and 'r_slide' have 3 and 3 joints, expected "
      "6 each: fewer cannot place a foot in every direction");
}

TEST(BodyPlanTest, ARobotWithoutLegsIsNamed) {
  const std::string urdf = ReplacedEverywhere(TwoLeggedUrdf(), "0 0 -0.8", "0 0 0.8");
  EXPECT_EQ(MessageOf<InputError>([&] { FindBodyPlan(ParseUrdf(urdf, "a.urdf"), "a.urdf"); }),
            "a.urdf: no two legs below the root link: expected a left and a right chain of joints "
            "(x ahead, y to the left, z up in the root link's frame)");
}

}  // namespace
}  // namespace possibility::models
