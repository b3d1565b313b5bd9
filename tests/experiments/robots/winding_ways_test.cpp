#include "experiments/robots/winding_ways.h"

#include <gtest/gtest.h>

#include <limits>

#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class WindingWaysTestLong : public ::testing::Test {
 protected:
  static fs::path FolderOf(const std::string& robot) {
    return fs::path(POSSIBILITY_SOURCE_DIR) / "models" / robot;
  }
  static models::RobotModel Load(const std::string& name) {
    return models::LoadRobotModel(FolderOf(name) / (name + ".yaml"));
  }
  static WindingWays Walk(const models::RobotModel& robot) {
    return WalkWindingWays(robot, "walk", FolderOf(robot.name) / "jumps",
                           robot.gaits.front().posture.root_height);
  }
};

TEST_F(WindingWaysTestLong, ARobotThatWalksIsNotRefused) {
  const WindingWays ways = Walk(Load("t1"));
  EXPECT_EQ(ways.tried, 8);
  EXPECT_TRUE(ways.AllVerified()) << ways.refusal;
  EXPECT_EQ(ways.refusal, "");
}

/// Joints without a limit of effort have no feedback in the simulation (JointStiffness).
TEST_F(WindingWaysTestLong, ARobotWithoutFeedbackAtItsAnklesIsRefused) {
  models::RobotModel robot = Load("t1");
  for (models::Joint& joint : robot.joints) {
    if (joint.name.find("Ankle") == std::string::npos) continue;
    joint.effort = std::numeric_limits<double>::infinity();
  }
  const WindingWays ways = Walk(robot);
  EXPECT_FALSE(ways.AllVerified());
  EXPECT_EQ(ways.refusal.find("winding way 1 of 8: rollout, "), 0u) << ways.refusal;
}

TEST_F(WindingWaysTestLong, EveryShippedRobotWalksThem) {
  for (const std::string name : {"a1", "drchubo1", "h1_2"}) {
    const WindingWays ways = Walk(Load(name));
    EXPECT_TRUE(ways.AllVerified()) << name << ": " << ways.refusal;
  }
}

}  // namespace
}  // namespace possibility::experiments
