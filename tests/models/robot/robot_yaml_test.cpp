#include "models/robot/robot_yaml.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"

namespace possibility::models {
namespace {

RobotModel LoadTwoLegged() {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", TwoLeggedUrdf());
  return LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
}

TEST(RobotYaml, ReadsTheModel) {
  const RobotModel robot = LoadTwoLegged();
  EXPECT_EQ(robot.name, "two_legged");
  EXPECT_EQ(robot.num_joints(), 6);
  EXPECT_EQ(robot.num_links(), 7);
  EXPECT_NEAR(robot.TotalMass(), 16, 1e-12);
  EXPECT_DOUBLE_EQ(robot.friction, 0.6);
  EXPECT_EQ(robot.joints[robot.JointIndex("l_yaw")].effort, 30);
  EXPECT_EQ(robot.joints[robot.JointIndex("l_roll")].effort, 50);
  const Joint& slide = robot.joints[robot.JointIndex("l_slide")];
  EXPECT_EQ(slide.type, JointType::kPrismatic);
  EXPECT_TRUE(slide.axis.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(robot.links[slide.parent].name, "l_thigh");
  EXPECT_EQ(robot.links[0].shapes.size(), 2u);  // its own and the tool's
  const std::vector<PosedShape>& foot = robot.links[robot.LinkIndex("l_foot")].shapes;
  ASSERT_EQ(foot.size(), 1u);
  EXPECT_TRUE((foot[0].X_PS * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, 0, -0.1)));
  EXPECT_TRUE(robot.contacts[0].normal_L.isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(robot.ignored_collisions.size(), 1u);
}

const std::string kInertials =
    "inertials:\n  - {link: l_hip, mass: 3, com: [0.1, 0.2, 0.3], moments: [1, 2, 2.5], products: "
    "[0.1, -0.2, 0.3], reason: weighed}\n";

TEST(RobotYaml, InertialsReplaceThoseOfTheUrdf) {
  const TemporaryFolder folder;
  // No body has the one in the URDF.
  std::string urdf = TwoLeggedUrdf();
  const std::size_t at = urdf.find("ixx=\"0.02\"", urdf.find("<link name=\"l_hip\">"));
  urdf.replace(at, 10, "ixx=\"-2.0\"");
  folder.Write("robot.urdf", urdf);
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml() + kInertials));
  const Inertial& body = robot.links[robot.LinkIndex("l_hip")].inertial;
  EXPECT_EQ(body.mass, 3);
  EXPECT_TRUE(body.p_LC.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  Eigen::Matrix3d expected;
  expected << 1, 0.1, -0.2, 0.1, 2, 0.3, -0.2, 0.3, 2.5;
  EXPECT_TRUE(body.I_LC.isApprox(expected));
  EXPECT_THROW(LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml())), InputError);
}

TEST(RobotYaml, OrdersJointsDepthFirstByName) {
  const RobotModel robot = LoadTwoLegged();
  std::vector<std::string> names;
  for (const Joint& joint : robot.joints) names.push_back(joint.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"l_yaw", "l_roll", "l_slide", "r_yaw", "r_roll", "r_slide"}));
}

TEST(RobotYaml, ReadsDegreesAndMetres) {
  const RobotModel robot = LoadTwoLegged();
  const Gait& stand = robot.GaitNamed("stand");
  EXPECT_NEAR(stand.posture.joints[robot.JointIndex("l_yaw")], 10 * M_PI / 180, 1e-15);
  EXPECT_NEAR(stand.parameters.turn, 10 * M_PI / 180, 1e-15);
  const Gait& squat = robot.GaitNamed("squat");
  EXPECT_DOUBLE_EQ(squat.posture.joints[robot.JointIndex("l_slide")], 0.3);
}

TEST(RobotYaml, TransitionsNameTheirGaits) {
  const RobotModel robot = LoadTwoLegged();
  ASSERT_EQ(robot.transitions.size(), 1u);
  EXPECT_EQ(robot.transitions[0].from, "stand");
  EXPECT_EQ(robot.transitions[0].to, "squat");
}

TEST(RobotYaml, HashDependsOnBothFilesAndNothingElse) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  for (const TemporaryFolder* folder : {&first, &second}) {
    folder->Write("robot.urdf", TwoLeggedUrdf());
    folder->Write("robot.yaml", TwoLeggedYaml());
  }
  const std::string hash = LoadRobotModel(first.path() / "robot.yaml").content_hash;
  EXPECT_EQ(hash.size(), 32u);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(LoadRobotModel(second.path() / "robot.yaml").content_hash, hash);
  second.Write("robot.urdf", TwoLeggedUrdf() + "\n");
  EXPECT_NE(LoadRobotModel(second.path() / "robot.yaml").content_hash, hash);
  first.Write("robot.yaml", TwoLeggedYaml() + "\n");
  EXPECT_NE(LoadRobotModel(first.path() / "robot.yaml").content_hash, hash);
}

/// A comment may end the YAML or begin the URDF. The robots differ, if only for a reader.
TEST(RobotYaml, HashChangesWhenTextMovesFromOneFileToTheOther) {
  const std::string moved = "<!-- moved -->";
  const TemporaryFolder folder;
  folder.Write("robot.urdf", TwoLeggedUrdf());
  folder.Write("robot.yaml", TwoLeggedYaml() + "#" + moved);
  const std::string hash = LoadRobotModel(folder.path() / "robot.yaml").content_hash;
  folder.Write("robot.urdf", moved + TwoLeggedUrdf());
  folder.Write("robot.yaml", TwoLeggedYaml() + "#");
  EXPECT_NE(LoadRobotModel(folder.path() / "robot.yaml").content_hash, hash);
}

TEST(RobotYaml, ConfigurationPlacesTheRoot) {
  const RobotModel robot = LoadTwoLegged();
  Posture posture = robot.GaitNamed("stand").posture;
  posture.root_pitch = -0.7;
  const Eigen::VectorXd q = robot.Configuration(posture, 1, 2, 0.4, 0.25);
  ASSERT_EQ(q.size(), robot.nq());
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  EXPECT_NEAR(R(2, 0), std::sin(0.7), 1e-12);  // body x tips up
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 0.4, 1e-12);
  EXPECT_TRUE(q.segment<3>(4).isApprox(Eigen::Vector3d(1, 2, 1.25)));
  EXPECT_TRUE(q.tail(6).isApprox(posture.joints));
}

TEST(RobotYaml, UnknownNamesSuggestTheNearest) {
  const RobotModel robot = LoadTwoLegged();
  const std::string file = robot.file.string();
  const auto message = [](auto lookup) -> std::string {
    try {
      lookup();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_EQ(message([&] { robot.LinkIndex("l_fot"); }),
            file + ": unknown link 'l_fot' (did you mean 'l_foot'?)");
  EXPECT_EQ(message([&] { robot.JointIndex("r_rol"); }),
            file + ": unknown joint 'r_rol' (did you mean 'r_roll'?)");
  EXPECT_EQ(message([&] { robot.ContactIndex("lefty"); }),
            file + ": unknown contact 'lefty' (did you mean 'left'?)");
  EXPECT_EQ(message([&] { robot.GaitNamed("xyzzy"); }), file + ": unknown gait 'xyzzy'");
}

TEST(RobotYaml, ContinuousJointsHaveNoPositionLimits) {
  const TemporaryFolder folder;
  std::string urdf = TwoLeggedUrdf();
  for (const std::string side : {"l", "r"}) {
    const std::string yaw = "name=\"" + side + "_yaw\" type=\"";
    urdf.replace(urdf.find(yaw) + yaw.size(), std::string("revolute").size(), "continuous");
  }
  folder.Write("robot.urdf", urdf);
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
  const Joint& joint = robot.joints[robot.JointIndex("l_yaw")];
  EXPECT_EQ(joint.type, JointType::kContinuous);
  EXPECT_EQ(joint.lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(joint.upper, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace possibility::models
