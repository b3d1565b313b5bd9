#include "experiments/exports/mujoco_tree.h"

#include <gtest/gtest.h>

#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

/// Two joints on the root and one on the first of them, numbered breadth first.
models::RobotModel BranchedRobot() {
  models::RobotModel robot = testing::SampleRobot();
  models::Joint joint = robot.joints[0];
  robot.links.push_back(robot.links[1]);
  robot.links.push_back(robot.links[1]);
  joint.name = "other";
  robot.joints.push_back(joint);
  joint.name = "knee";
  joint.parent = 1;
  robot.joints.push_back(joint);
  return robot;
}

TEST(MujocoTreeTest, JointsComeDepthFirst) {
  const models::RobotModel robot = BranchedRobot();
  const MujocoTree tree(robot);
  EXPECT_EQ(tree.joints(), std::vector<int>({0, 2, 1}));
  Eigen::VectorXd q(10);
  q << 1, 0, 0, 0, 4, 5, 6, 7, 8, 9;
  Eigen::VectorXd qpos(10);
  qpos << 4, 5, 6, 1, 0, 0, 0, 7, 9, 8;
  EXPECT_EQ(tree.Positions(q), qpos);
  EXPECT_EQ(tree.Controls(Eigen::Vector3d(1, 2, 3)), Eigen::Vector3d(1, 3, 2));
}

TEST(MujocoTreeTest, AngularVelocityIsInTheRootsAxes) {
  const models::RobotModel robot = BranchedRobot();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(10);
  q.head<4>() << std::sqrt(0.5), 0, 0, std::sqrt(0.5);  // a quarter turn about z
  Eigen::VectorXd v(9);
  v << 1, 0, 2, 3, 4, 5, 6, 7, 8;
  Eigen::VectorXd qvel(9);
  qvel << 3, 4, 5, 0, -1, 2, 6, 8, 7;
  EXPECT_LT((MujocoTree(robot).Rates(q, v) - qvel).norm(), 1e-14);
}

TEST(MujocoTreeTest, AMasterBearsItsMimics) {
  models::RobotModel robot = BranchedRobot();
  robot.joints[1].mimic = models::Mimic{0, -2, 0};
  const MujocoTree tree(robot);
  EXPECT_EQ(tree.motors(), std::vector<int>({0, 2}));
  EXPECT_EQ(tree.Controls(Eigen::Vector3d(10, 3, 5)), Eigen::Vector2d(10 - 6, 5));
}

}  // namespace
}  // namespace possibility::experiments
