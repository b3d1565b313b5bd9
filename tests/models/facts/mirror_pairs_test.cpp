#include "models/facts/mirror_pairs.h"

#include <gtest/gtest.h>

#include <set>

#include "models/facts/zero_poses.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

RobotModel Hubo() {
  return LoadRobotModel(std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/drchubo1.yaml");
}

// The list in DRC-HUBO1's YAML was written by hand.
TEST(MirrorPairsTest, FindsThePairsOfDrcHubo1) {
  const RobotModel robot = Hubo();
  const MirrorPairs found = FindMirrorPairs(robot, 0.025);
  const std::set<std::pair<int, int>> expected(robot.sagittal_pairs.begin(),
                                               robot.sagittal_pairs.end());
  std::set<std::pair<int, int>> pairs;
  for (const auto& pair : found.pairs) pairs.insert({pair.left, pair.right});
  EXPECT_EQ(pairs, expected);
  EXPECT_TRUE(found.unpaired.empty());
  EXPECT_LT(found.worst_distance, kSymmetric);
}

TEST(MirrorPairsTest, TheMirroredPostureIsTheMirrorImage) {
  const RobotModel robot = Hubo();
  const MirrorPairs found = FindMirrorPairs(robot, 0.025);
  testing::RandomGeometry random(31);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd joints(robot.num_joints());
    for (double& value : joints) value = random.Uniform(-1, 1);
    joints[robot.JointIndex("TSY")] = 0;  // a turn of the waist mirrors to the opposite turn
    const auto X = PosesInRoot(robot, joints);
    const auto Y = PosesInRoot(robot, found.Mirrored(joints));
    for (const auto& [left, right, sign] : found.pairs) {
      const Eigen::Vector3d image =
          X[left + 1].translation().cwiseProduct(Eigen::Vector3d(1, -1, 1));
      EXPECT_LT((image - Y[right + 1].translation()).norm(), 2e-3) << robot.joints[left].name;
    }
  }
}

// Where a URDF puts the origin along a joint's axis changes nothing of the robot.
TEST(MirrorPairsTest, AnOriginMayBeAnywhereOnTheAxis) {
  RobotModel robot = Hubo();
  const MirrorPairs before = FindMirrorPairs(robot, 0.025);
  for (const std::string name : {"LHP", "LKP", "REP", "LSR"}) {
    const int joint = robot.JointIndex(name);
    Joint& moved = robot.joints[joint];
    moved.X_PJ.translation() += 0.06 * (moved.X_PJ.linear() * moved.axis);
    for (Joint& child : robot.joints) {
      if (child.parent == joint + 1) child.X_PJ.translation() -= 0.06 * moved.axis;
    }
  }
  const MirrorPairs after = FindMirrorPairs(robot, 0.025);
  ASSERT_EQ(after.pairs.size(), before.pairs.size());
  for (std::size_t i = 0; i < before.pairs.size(); ++i) {
    EXPECT_EQ(after.pairs[i].left, before.pairs[i].left);
    EXPECT_EQ(after.pairs[i].right, before.pairs[i].right);
  }
  EXPECT_NEAR(after.worst_distance, before.worst_distance, 1e-3);
}

TEST(MirrorPairsTest, NamesTheWorstLinkAndWhatHasNoImage) {
  RobotModel robot = Hubo();
  robot.joints[robot.JointIndex("LEP")].X_PJ.translation().x() += 0.007;
  robot.links[robot.LinkIndex("Body_LHP")].inertial.mass += 0.5;
  MirrorPairs found = FindMirrorPairs(robot, 0.025);
  EXPECT_EQ(found.pairs.size(), robot.sagittal_pairs.size());
  EXPECT_NEAR(found.worst_distance, 0.007, 2e-3);
  EXPECT_EQ(found.worst_mass_link, "Body_LHP");
  robot.joints[robot.JointIndex("LEP")].X_PJ.translation().x() += 0.1;
  found = FindMirrorPairs(robot, 0.025);
  EXPECT_NE(std::find(found.unpaired.begin(), found.unpaired.end(), robot.JointIndex("LEP")),
            found.unpaired.end());
}

}  // namespace
}  // namespace possibility::models
