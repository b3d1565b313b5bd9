#include "experiments/mjcf/mjcf_robot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "experiments/exports/mujoco_export.h"
#include "models/facts/srdf_reader.h"
#include "models/facts/zero_poses.h"
#include "models/input/input_error.h"
#include "models/mesh/mesh_reader.h"
#include "models/robot/robot_yaml.h"
#include "models/robot/urdf_robot.h"
#include "tests/experiments/sample_plan.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"
#include "tests/replaced.h"
#ifdef POSSIBILITY_WITH_MUJOCO
#include <mujoco/mujoco.h>
#endif

namespace possibility::experiments {
namespace {

#ifdef POSSIBILITY_WITH_MUJOCO

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A tree with all that MJCF has and URDF has not: several joints in a body and away from its
/// origin, `ref`, a turned root, defaults, degrees, inertias of geoms.
constexpr const char* kTree = R"(
<mujoco model="tree">
  <compiler angle="degree" autolimits="true"/>
  <default><joint range="-60 90" damping="1"/><geom density="700"/></default>
  <asset>
    <mesh name="wedge" vertex="0 0 0  0.1 0 0  0 0.2 0  0 0 0.3  0.1 0.2 0.3"/>
  </asset>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <body name="table" pos="2 0 0"><geom type="box" size="0.3 0.3 0.3"/></body>
    <body name="pelvis" pos="0 0 1" euler="0 0 30">
      <freejoint/>
      <geom type="box" size="0.1 0.12 0.08" pos="0.01 0 0.02"/>
      <body name="thigh" pos="0 0.1 -0.05" euler="10 -5 20">
        <joint name="yaw" axis="0 0 1" pos="0.01 0.02 0.03"/>
        <joint name="roll" axis="1 0 0" pos="-0.02 0 0.01" ref="15"/>
        <joint name="pitch" axis="0 1 0.2" pos="0 0 -0.03"/>
        <geom type="capsule" fromto="0 0 0 0.02 0 -0.3" size="0.05"/>
        <body name="shank" pos="0 0 -0.3">
          <joint name="knee" axis="0 1 0" pos="0 0 0.02" range="0 120"/>
          <geom type="cylinder" size="0.04 0.15" pos="0 0 -0.15" euler="0 3 0"/>
          <body name="plate" pos="0.03 0 -0.1" euler="0 45 0">
            <geom type="mesh" mesh="wedge" pos="0.01 0.02 0"/>
            <geom type="sphere" size="0.02" contype="0" conaffinity="0"/>
          </body>
        </body>
      </body>
      <body name="mast" pos="0 0 0.1">
        <joint name="slide" type="slide" axis="0 0 1" range="-0.1 0.2"/>
        <geom type="ellipsoid" size="0.05 0.06 0.2"/>
        <body name="follower" pos="0 0 0.2">
          <joint name="follow" axis="0 0 1"/>
          <geom type="sphere" size="0.05" pos="0.05 0 0"/>
        </body>
      </body>
    </body>
  </worldbody>
  <contact><exclude body1="pelvis" body2="shank"/></contact>
  <actuator>
    <motor joint="knee" gear="20" ctrlrange="-2 3"/>
    <position joint="yaw" kp="100" forcerange="-30 30"/>
    <position joint="roll" kp="100"/>
  </actuator>
  <equality><joint joint1="follow" joint2="yaw" polycoef="0.1 -0.5 0 0 0"/></equality>
</mujoco>)";

class MjcfRobotTest : public ::testing::Test {
 protected:
  MjcfRobot Read(const std::string& xml) { return ReadMjcf(folder_.Write("x.xml", xml), "x"); }
  std::string ErrorOf(const std::string& xml) {
    const std::string error = MessageOf<InputError>([&] { Read(xml); });
    EXPECT_EQ(error.find('\n'), std::string::npos);
    const std::string file = (folder_.path() / "x.xml").string() + ": ";
    EXPECT_EQ(error.substr(0, file.size()), file);
    return error.substr(std::min(error.size(), file.size()));
  }

  models::TemporaryFolder folder_;
};

models::RobotModel RobotOf(const MjcfRobot& mjcf) {
  return models::BuildUrdfRobot(models::ParseUrdf(mjcf.urdf, "x.urdf"), {}, "x.urdf").robot;
}

/// MuJoCo's own model and state.
struct Peer {
  explicit Peer(const std::filesystem::path& file) {
    std::array<char, 1000> error{};
    model = mj_loadXML(file.c_str(), nullptr, error.data(), 1000);
    EXPECT_NE(model, nullptr) << error.data();
    data = mj_makeData(model);
  }
  ~Peer() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  double& Position(const std::string& joint) {
    const int id = mj_name2id(model, mjOBJ_JOINT, joint.c_str());
    return data->qpos[model->jnt_qposadr[id]];
  }
  double Zero(const std::string& joint) const {
    const int id = mj_name2id(model, mjOBJ_JOINT, joint.c_str());
    return model->qpos0[model->jnt_qposadr[id]];
  }
  mjModel* model = nullptr;
  mjData* data = nullptr;
};

Isometry3d PoseOf(const mjtNum* position, const mjtNum* rotation) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = Vector3d(position[0], position[1], position[2]);
  X.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation);
  return X;
}

/// Masses, centres of mass and inertias of all links that are bodies of MuJoCo's, at random angles.
void ExpectTheSameBodies(const models::RobotModel& robot, Peer* peer, int trials) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-1, 1);
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::VectorXd joints(robot.num_joints());
    for (int i = 0; i < robot.num_joints(); ++i) joints[i] = angle(random);
    for (int i = 0; i < robot.num_joints(); ++i) {
      const models::Joint& joint = robot.joints[i];
      if (joint.mimic) {
        joints[i] = joint.mimic->multiplier * joints[joint.mimic->joint] + joint.mimic->offset;
      }
      peer->Position(joint.name) = peer->Zero(joint.name) + joints[i];
    }
    mj_kinematics(peer->model, peer->data);
    const std::vector<Isometry3d> poses = models::PosesInRoot(robot, joints);
    int compared = 0;
    std::optional<Isometry3d> X_WR;
    for (int link = 0; link < robot.num_links(); ++link) {
      const models::Inertial& inertial = robot.links[link].inertial;
      const int id = mj_name2id(peer->model, mjOBJ_BODY, robot.links[link].name.c_str());
      if (id < 0) continue;
      const Isometry3d X = PoseOf(peer->data->xipos + 3 * id, peer->data->ximat + 9 * id);
      const Matrix3d I_W =
          X.linear() *
          Vector3d(Eigen::Map<Vector3d>(peer->model->body_inertia + 3 * id)).asDiagonal() *
          X.linear().transpose();
      if (!X_WR) {  // the root comes first: where MuJoCo has it
        X_WR = PoseOf(peer->data->xpos + 3 * id, peer->data->xmat + 9 * id) * poses[link].inverse();
      }
      const Isometry3d X_WL = *X_WR * poses[link];
      EXPECT_NEAR(inertial.mass, peer->model->body_mass[id], 1e-9) << robot.links[link].name;
      EXPECT_TRUE((X_WL * inertial.p_LC).isApprox(X.translation(), 1e-9)) << robot.links[link].name;
      const Matrix3d ours = X_WL.linear() * inertial.I_LC * X_WL.linear().transpose();
      EXPECT_LT((ours - I_W).norm(), 1e-9 + 1e-7 * I_W.norm()) << robot.links[link].name;
      ++compared;
    }
    EXPECT_GE(compared, 4);
  }
}

TEST_F(MjcfRobotTest, BodiesMoveAsInMujoco) {
  const std::string loose =
      Replaced(kTree, "<body name=\"plate\" pos=\"0.03 0 -0.1\" euler=\"0 45 0\">",
               "<body name=\"plate\" pos=\"0.03 0 -0.1\" euler=\"0 45 0\"><joint "
               "name=\"hinge\" axis=\"1 0 1\"/>");
  const MjcfRobot mjcf = Read(loose);
  const models::RobotModel robot = RobotOf(mjcf);
  Peer peer(folder_.path() / "x.xml");
  ExpectTheSameBodies(robot, &peer, 50);
}

TEST_F(MjcfRobotTest, DrcHubo1ComesBackFromItsExport) {
  const models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  const actions::Plan plan = testing::SamplePlan(robot, 2, 3);
  const std::string xml = MujocoXml({plan, robot, testing::SampleScenario()}, {0.5, false});
  const models::RobotModel again = RobotOf(Read(xml));
  EXPECT_EQ(again.num_joints(), robot.num_joints());
  EXPECT_NEAR(again.TotalMass(), robot.TotalMass(), 1e-6);
  for (const models::Joint& joint : robot.joints) {
    const models::Joint& other = again.joints[again.JointIndex(joint.name)];
    EXPECT_NEAR(other.lower, joint.lower, 1e-6) << joint.name;
    EXPECT_NEAR(other.upper, joint.upper, 1e-6) << joint.name;
  }
  Peer peer(folder_.path() / "x.xml");
  ExpectTheSameBodies(again, &peer, 10);
}

TEST_F(MjcfRobotTest, LimitsAreThoseOfJointsAndActuators) {
  const models::RobotModel robot = RobotOf(Read(kTree));
  const auto joint = [&](const std::string& name) { return robot.joints[robot.JointIndex(name)]; };
  constexpr double kDegree = std::numbers::pi / 180;
  EXPECT_NEAR(joint("yaw").lower, -60 * kDegree, 1e-12);
  EXPECT_NEAR(joint("yaw").upper, 90 * kDegree, 1e-12);
  EXPECT_NEAR(joint("roll").lower, -75 * kDegree, 1e-12) << "`ref` is our zero";
  EXPECT_NEAR(joint("knee").upper, 120 * kDegree, 1e-12);
  EXPECT_EQ(joint("slide").type, models::JointType::kPrismatic);
  EXPECT_NEAR(joint("slide").upper, 0.2, 1e-12);
  EXPECT_EQ(joint("yaw").effort, 30);
  EXPECT_EQ(joint("knee").effort, 60) << "gear times the larger end of the control's range";
  EXPECT_EQ(joint("roll").effort, 0) << "a servo without a limit";
  ASSERT_TRUE(joint("follow").mimic);
  EXPECT_EQ(joint("follow").mimic->multiplier, -0.5);
  EXPECT_EQ(joint("follow").mimic->offset, 0.1);
}

TEST_F(MjcfRobotTest, ShapesMeshesAndExcludedPairsAreTakenOver) {
  const MjcfRobot mjcf = Read(kTree);
  const models::UrdfTree tree = models::ParseUrdf(mjcf.urdf, "x.urdf");
  std::map<std::string, std::size_t> shapes, meshes;
  for (const models::UrdfLink& link : tree.links) {
    shapes[link.name] = link.shapes.size();
    meshes[link.name] = link.meshes.size();
  }
  EXPECT_EQ(shapes["pelvis"], 1u);
  EXPECT_EQ(shapes["plate"], 0u) << "its sphere is only seen";
  EXPECT_EQ(meshes["plate"], 1u);
  EXPECT_EQ(shapes.count("table"), 0u);
  ASSERT_EQ(mjcf.files.size(), 1u);
  EXPECT_EQ(mjcf.files[0].name, "meshes/0_wedge.stl");
  const models::TriangleMesh mesh = models::ParseMesh(mjcf.files[0].bytes, "wedge.stl");
  EXPECT_NEAR(mesh.Bounds().sizes().maxCoeff(), 0.3, 0.1);
  const models::Srdf srdf = models::ParseSrdf(mjcf.srdf, "x.srdf", tree);
  ASSERT_EQ(srdf.disabled.size(), 1u);
  EXPECT_EQ(mjcf.findings.size(), 4u) << "the table, two links between joints, the ellipsoid";
}

TEST_F(MjcfRobotTest, WhatCannotBeARobotIsNamed) {
  const std::string tree = kTree;
  EXPECT_EQ(
      ErrorOf("<mujoco><worldbody><body name=\"a\"><geom size=\"1\"/></body></worldbody></mujoco>"),
      "expected a robot, a tree of bodies with hinges; no body has one");
  EXPECT_EQ(ErrorOf(Replaced(tree, "<body name=\"table\" pos=\"2 0 0\">",
                             "<body name=\"table\" pos=\"2 0 0\"><joint/>")),
            "expected one robot, got 2 trees of bodies with joints: table, pelvis");
  EXPECT_EQ(ErrorOf(Replaced(
                tree, "<joint name=\"knee\" axis=\"0 1 0\" pos=\"0 0 0.02\" range=\"0 120\"/>",
                "<joint name=\"knee\" type=\"ball\" range=\"0 0\"/>")),
            "joint 'knee' is a ball joint: expected hinges and slides");
  EXPECT_EQ(ErrorOf(Replaced(tree, "<freejoint/>", "<joint name=\"rail\" type=\"slide\"/>")),
            "body 'pelvis' moves by 'rail' in the world: expected a free joint");
  EXPECT_EQ(ErrorOf(Replaced(tree, "0.1 -0.5 0 0 0", "0.1 -0.5 0.3 0 0")),
            "equality 'equality_0': expected joint 'follow' to follow another one in proportion");
  EXPECT_EQ(
      ErrorOf(Replaced(tree, "<equality>",
                       "<equality><connect body1=\"shank\" body2=\"mast\" anchor=\"0 0 0\"/>")),
      "equality 'equality_0' closes a loop from body 'shank' to 'mast': expected a tree");
  EXPECT_NE(ErrorOf("<mujoco><worldbody><bdy/></worldbody></mujoco>").find("bdy"),
            std::string::npos);
  EXPECT_FALSE(ErrorOf("no xml").empty());
  EXPECT_NE(MessageOf<InputError>([&] { ReadMjcf("none.xml", "x"); }).find("none.xml"),
            std::string::npos);
}

TEST_F(MjcfRobotTest, WhatOnlyNewerMujocoKnowsIsLeftOut) {
  std::string text = Replaced(kTree, " autolimits=\"true\"", "");
  text = Replaced(text, "<default>", "<option integrator=\"implicitfast\"/><default>");
  text = Replaced(text, "ref=\"15\"",
                  "ref=\"15\" actuatorfrclimited='true'\n actuatorfrcrange=\"-8 9\"");
  folder_.Write("part.xml", "<mujoco>" +
                                text.substr(text.find("<worldbody>"),
                                            text.find("</worldbody>") - text.find("<worldbody>")) +
                                "</worldbody></mujoco>");
  text.replace(text.find("<worldbody>"), text.find("</worldbody>") - text.find("<worldbody>") + 12,
               "<include file=\"part.xml\"/>");
  const MjcfRobot mjcf = Read(text);
  const std::set<std::string> findings(mjcf.findings.begin(), mjcf.findings.end());
  for (const std::string what : {"'implicitfast' of <option>", "'actuatorfrclimited' of <joint>"}) {
    EXPECT_EQ(findings.count(what + " is left out: this MuJoCo does not know it"), 1u) << what;
  }
  const models::RobotModel robot = RobotOf(mjcf);
  EXPECT_EQ(robot.joints[robot.JointIndex("roll")].effort, 9);
  EXPECT_EQ(robot.TotalMass(), RobotOf(Read(kTree)).TotalMass());
}

TEST_F(MjcfRobotTest, MaterialsThatNothingDefinesAreLeftOut) {
  const std::string text = Replaced(kTree, "<geom ", "<geom material=\"grid\" ");
  const MjcfRobot mjcf = Read(text);
  EXPECT_EQ(std::count(mjcf.findings.begin(), mjcf.findings.end(),
                       "material 'grid' is not defined, and left out"),
            1);
  EXPECT_EQ(mjcf.urdf, Read(kTree).urdf);
}

TEST_F(MjcfRobotTest, ThreeSlidesAndThreeHingesFloat) {
  std::string joints;
  for (const std::string type : {"slide", "hinge"}) {
    for (const std::string axis : {"1 0 0", "0 1 0", "0 0 1"}) {
      joints += fmt::format("<joint type=\"{}\" axis=\"{}\"/>", type, axis);
    }
  }
  const models::RobotModel robot = RobotOf(Read(Replaced(kTree, "<freejoint/>", joints)));
  EXPECT_EQ(robot.num_joints(), RobotOf(Read(kTree)).num_joints());
}

TEST_F(MjcfRobotTest, SpoiltFilesGiveOneLine) {
  std::mt19937 random(13);
  for (int trial = 0; trial < 200; ++trial) {
    std::string text = kTree;
    for (int i = 0; i < 6; ++i)
      text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    try {
      RobotOf(Read(text));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
}

#else

TEST(MjcfRobotTest, WithoutMujocoItSaysWhatToInstall) {
  EXPECT_NE(MessageOf<InputError>([&] { ReadMjcf("x.xml", "x"); }).find("libmujoco-dev"),
            std::string::npos);
}

#endif

}  // namespace
}  // namespace possibility::experiments
