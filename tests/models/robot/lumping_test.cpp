#include "models/robot/lumping.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"

namespace possibility::models {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Spatial inertia about the world origin. Lumping needs no other physics than their sum.
Matrix6d SpatialInertia(const Inertial& body, const Eigen::Isometry3d& X_WL) {
  const Eigen::Vector3d c = X_WL * body.p_LC;
  Eigen::Matrix3d cross;
  cross << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  Matrix6d inertia;
  inertia.topLeftCorner<3, 3>() =
      X_WL.linear() * body.I_LC * X_WL.linear().transpose() + body.mass * cross * cross.transpose();
  inertia.topRightCorner<3, 3>() = body.mass * cross;
  inertia.bottomLeftCorner<3, 3>() = body.mass * cross.transpose();
  inertia.bottomRightCorner<3, 3>() = body.mass * Eigen::Matrix3d::Identity();
  return inertia;
}

Eigen::Isometry3d RandomPose(std::mt19937* random) {
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(*random); };
  return Eigen::Translation3d(draw(), draw(), draw()) *
         Eigen::Quaterniond(draw(), draw(), draw(), draw()).normalized();
}

Inertial RandomInertial(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(0.1, 1);
  const Eigen::Vector3d squares(uniform(*random), uniform(*random), uniform(*random));
  const Eigen::Matrix3d R = RandomPose(random).linear();
  Inertial body;
  body.mass = uniform(*random);
  body.p_LC = RandomPose(random).translation();
  body.I_LC = R * Eigen::Vector3d(squares.sum() * Eigen::Vector3d::Ones() - squares).asDiagonal() *
              R.transpose();
  return body;
}

TEST(Lumping, CombinedAddsSpatialInertias) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 1000; ++trial) {
    const Inertial a = RandomInertial(&random);
    const Inertial b = RandomInertial(&random);
    const Eigen::Isometry3d X_PL = RandomPose(&random);
    const Matrix6d expected =
        SpatialInertia(a, Eigen::Isometry3d::Identity()) + SpatialInertia(b, X_PL);
    EXPECT_TRUE(SpatialInertia(Combined(a, b, X_PL), Eigen::Isometry3d::Identity())
                    .isApprox(expected, 1e-12));
  }
}

/// The two-legged robot with another inertial in its tool, which is on a fixed joint.
RobotModel WithTool(const std::string& mass, const std::string& moment) {
  const std::string inertial = "<origin xyz=\"0.1 0 0\"/><mass value=\"" + mass +
                               "\"/><inertia ixx=\"" + moment + "\" ixy=\"0\" ixz=\"0\" iyy=\"" +
                               moment + "\" iyz=\"0\" izz=\"" + moment + "\"/>";
  std::string urdf = TwoLeggedUrdf();
  const std::size_t begin = urdf.find("<inertial>", urdf.find("<link name=\"tool\">")) + 10;
  urdf.replace(begin, urdf.find("</inertial>", begin) - begin, inertial);
  const TemporaryFolder folder;
  folder.Write("robot.urdf", urdf);
  return LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
}

TEST(Lumping, AFrameWithoutMassAddsNothing) {
  const RobotModel robot = WithTool("0", "0");
  EXPECT_EQ(robot.links[0].inertial.mass, 2);
  EXPECT_TRUE(robot.links[0].inertial.p_LC.isApprox(Eigen::Vector3d(0.01, 0.02, -0.03)));
}

TEST(Lumping, APointMassIsLumped) {
  const RobotModel robot = WithTool("3", "0");
  const Inertial& sum = robot.links[0].inertial;
  // The tool is 0.3 m above the base, turned by 0.5 rad about y.
  const Eigen::Vector3d base(0.01, 0.02, -0.03);
  const Eigen::Vector3d point(0.1 * std::cos(0.5), 0, 0.3 - 0.1 * std::sin(0.5));
  EXPECT_EQ(sum.mass, 5);
  EXPECT_TRUE(sum.p_LC.isApprox((2 * base + 3 * point) / 5));
  // Two bodies add m1 m2 / (m1 + m2) d^2 about an axis across the line between them.
  Eigen::Matrix3d own;
  own << 0.02, 0.001, 0, 0.001, 0.03, 0, 0, 0, 0.04;
  EXPECT_NEAR(sum.I_LC.trace(), own.trace() + 2 * 1.2 * (base - point).squaredNorm(), 1e-12);
}

TEST(Lumping, WhatMovesIsABody) {
  EXPECT_THROW(WithTool("-1", "0"), InputError);
  EXPECT_THROW(WithTool("1", "-1"), InputError);
}

class DrcHubo1Lumping : public ::testing::Test {
 protected:
  DrcHubo1Lumping() {
    const std::string folder = std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/";
    robot_ = LoadRobotModel(folder + "drchubo1.yaml");
    tree_ = ParseUrdf(ReadFileContents(folder + "drchubo1.urdf"), "drchubo1.urdf");
  }

  // Poses of all 52 links of the URDF, with the joints that the model has lumped at 0.
  std::map<std::string, Eigen::Isometry3d> FullPoses(const Eigen::VectorXd& joints,
                                                     const Eigen::Isometry3d& X_WR) const {
    std::map<std::string, Eigen::Isometry3d> X_WL = {{tree_.root, X_WR}};
    while (X_WL.size() < tree_.links.size()) {
      for (const UrdfJoint& joint : tree_.joints) {
        if (!X_WL.contains(joint.parent)) continue;
        double angle = 0;
        for (int i = 0; i < robot_.num_joints(); ++i) {
          if (robot_.joints[i].name == joint.name) angle = joints[i];
        }
        X_WL[joint.child] = X_WL[joint.parent] * joint.X_PJ * Eigen::AngleAxisd(angle, joint.axis);
      }
    }
    return X_WL;
  }

  RobotModel robot_;
  UrdfTree tree_;
};

TEST_F(DrcHubo1Lumping, KeepsTheMassPropertiesOfTheFullTree) {
  EXPECT_EQ(tree_.links.size(), 52u);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::Isometry3d X_WR = RandomPose(&random);
    Eigen::VectorXd joints(robot_.num_joints());
    for (int i = 0; i < joints.size(); ++i) {
      const Joint& joint = robot_.joints[i];
      joints[i] = joint.lower + unit(random) * (joint.upper - joint.lower);
    }
    const auto X_full = FullPoses(joints, X_WR);
    Matrix6d expected = Matrix6d::Zero();
    for (const UrdfLink& link : tree_.links) {
      expected += SpatialInertia(*link.inertial, X_full.at(link.name));
    }
    Matrix6d lumped = Matrix6d::Zero();
    for (const Link& link : robot_.links) {
      lumped += SpatialInertia(link.inertial, X_full.at(link.name));
    }
    EXPECT_TRUE(lumped.isApprox(expected, 1e-12));
  }
}

TEST_F(DrcHubo1Lumping, MovesTheHeadsShapesToTheTorso) {
  Posture zero;
  zero.joints = Eigen::VectorXd::Zero(robot_.num_joints());
  const auto X_full = FullPoses(zero.joints, Eigen::Isometry3d::Identity());
  std::vector<PosedShape> expected;
  for (const std::string name : {"Body_Torso", "Body_NKY", "Body_NK1", "Body_NK2"}) {
    for (const UrdfLink& link : tree_.links) {
      if (link.name != name) continue;
      for (const PosedShape& posed : link.shapes) {
        expected.push_back({posed.shape, X_full.at(name) * posed.X_PS});
      }
    }
  }
  const std::vector<PosedShape>& torso = robot_.links[robot_.LinkIndex("Body_Torso")].shapes;
  ASSERT_EQ(torso.size(), expected.size());
  ASSERT_EQ(torso.size(), 4u);
  for (std::size_t i = 0; i < torso.size(); ++i) {
    EXPECT_TRUE(torso[i].X_PS.isApprox(expected[i].X_PS, 1e-9));
    EXPECT_EQ(torso[i].shape.size, expected[i].shape.size);
  }
}

}  // namespace
}  // namespace possibility::models
