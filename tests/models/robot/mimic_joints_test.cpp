// A robot with two arms whose joints are coupled, read from its files, which the tests modify.

#include "models/robot/mimic_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

/// <mimic> elements by joint of the arms: a_1 (revolute), a_2 (prismatic), a_3 (continuous) on the
/// left, b_1, b_2, b_3 likewise on the right; "a_fixed" fixed at the end of the left one.
std::string ArmedUrdf(const std::map<std::string, std::string>& mimics) {
  std::string urdf = TwoLeggedUrdf();
  urdf.resize(urdf.rfind("</robot>"));
  const auto joint = [&](const std::string& name, const std::string& type,
                         const std::string& parent) {
    urdf += "<link name=\"" + name + "_link\"><inertial><mass value=\"1\"/><inertia ixx=\"0.02\" " +
            "ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.02\"/></inertial></link>\n" +
            "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
            "\"/><child link=\"" + name + "_link\"/><axis xyz=\"0 1 0\"/>" +
            "<limit lower=\"-0.5\" upper=\"2\" velocity=\"5\" effort=\"50\"/>";
    if (const auto found = mimics.find(name); found != mimics.end()) urdf += found->second;
    urdf += "</joint>\n";
  };
  for (const std::string side : {"a", "b"}) {
    joint(side + "_1", "revolute", "base");
    joint(side + "_2", "prismatic", side + "_1_link");
    joint(side + "_3", "continuous", side + "_2_link");
  }
  joint("a_fixed", "fixed", "a_3_link");
  return urdf + "</robot>\n";
}

std::string ArmedYaml(const std::string& posture = "", const std::string& lump = "") {
  const std::string yaml = Replaced(TwoLeggedYaml(), "{l_yaw: 10}", "{l_yaw: 10" + posture + "}");
  return Replaced(yaml, "friction:", "lump: [" + lump + "]\nfriction:");
}

RobotModel Load(const std::string& yaml, const std::string& urdf) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", urdf);
  return LoadRobotModel(folder.Write("robot.yaml", yaml));
}

std::string MimicMessageOf(const std::string& yaml, const std::string& urdf) {
  try {
    Load(yaml, urdf);
  } catch (const InputError& error) {
    const std::string message = error.what();
    return message.substr(message.find("robot."));
  }
  return "no error";
}

std::string Element(const std::string& joint, double multiplier, double offset) {
  return "<mimic joint=\"" + joint + "\" multiplier=\"" + std::to_string(multiplier) +
         "\" offset=\"" + std::to_string(offset) + "\"/>";
}

TEST(MimicJoints, MultiplierAndOffsetMayBeLeftOut) {
  const RobotModel robot = Load(ArmedYaml(), ArmedUrdf({{"a_3", "<mimic joint=\"b_1\"/>"}}));
  const Joint& joint = robot.joints[robot.JointIndex("a_3")];
  ASSERT_TRUE(joint.mimic.has_value());
  EXPECT_EQ(joint.mimic->joint, robot.JointIndex("b_1"));
  EXPECT_EQ(joint.mimic->multiplier, 1);
  EXPECT_EQ(joint.mimic->offset, 0);
  EXPECT_EQ(joint.effort, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(robot.joints[robot.JointIndex("b_1")].mimic.has_value());
}

TEST(MimicJoints, MasterMayComeBeforeOrAfter) {
  const RobotModel robot = Load(
      ArmedYaml(), ArmedUrdf({{"a_3", Element("b_1", 2, 0.1)}, {"b_3", Element("a_1", -1, 0.2)}}));
  EXPECT_GT(robot.joints[robot.JointIndex("a_3")].mimic->joint, robot.JointIndex("a_3"));
  EXPECT_LT(robot.joints[robot.JointIndex("b_3")].mimic->joint, robot.JointIndex("b_3"));
}

/// a_3 follows b_3, which follows b_1. Each coupling of the chain must hold for any value of b_1.
TEST(MimicJoints, ChainsFollowTheLastMaster) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.1, 2);
  for (int trial = 0; trial < 20; ++trial) {
    const auto draw = [&] { return std::round(1e3 * uniform(random)) / 1e3; };
    const double m1 = draw(), m2 = -draw(), o1 = draw(), o2 = draw();
    const RobotModel robot = Load(
        ArmedYaml(), ArmedUrdf({{"a_3", Element("b_3", m1, o1)}, {"b_3", Element("b_1", m2, o2)}}));
    const int a_3 = robot.JointIndex("a_3"), b_3 = robot.JointIndex("b_3");
    EXPECT_EQ(robot.joints[a_3].mimic->joint, robot.JointIndex("b_1"));
    Eigen::VectorXd joints = Eigen::VectorXd::Constant(robot.num_joints(), uniform(random));
    FollowMasters(robot, &joints);
    EXPECT_NEAR(joints[b_3], m2 * joints[robot.JointIndex("b_1")] + o2, 1e-12);
    EXPECT_NEAR(joints[a_3], m1 * joints[b_3] + o1, 1e-12);
  }
}

TEST(MimicJoints, PosturesFollowTheMaster) {
  const std::string urdf = ArmedUrdf({{"a_3", Element("b_1", -2, 0.1)}});
  const RobotModel robot = Load(ArmedYaml(", b_1: 30"), urdf);
  const Eigen::VectorXd& joints = robot.GaitNamed("stand").posture.joints;
  EXPECT_NEAR(joints[robot.JointIndex("a_3")], -2 * 30 * M_PI / 180 + 0.1, 1e-12);
  // Not named: the master is at 0, the mimic at its offset.
  EXPECT_NEAR(robot.GaitNamed("squat").posture.joints[robot.JointIndex("a_3")], 0.1, 1e-12);
  EXPECT_EQ(MimicMessageOf(ArmedYaml(", b_1: 30, a_3: -54.27042"), urdf), "no error");
}

TEST(MimicJoints, LumpedMimicIsHeldAtZero) {
  const RobotModel robot = Load(ArmedYaml("", "a_3"), ArmedUrdf({{"a_3", Element("b_1", 2, 0.3)}}));
  for (const Joint& joint : robot.joints) EXPECT_FALSE(joint.mimic.has_value());
  EXPECT_EQ(robot.num_joints(), 11);
}

TEST(MimicJoints, MasterAndMimicAreCoupled) {
  const RobotModel robot = Load(ArmedYaml(), ArmedUrdf({{"a_3", Element("b_1", 2, 0)}}));
  for (int i = 0; i < robot.num_joints(); ++i) {
    const std::string& name = robot.joints[i].name;
    EXPECT_EQ(robot.IsCoupled(i), name == "a_3" || name == "b_1") << name;
  }
}

TEST(MimicJoints, NeedNoEffortLimit) {
  const std::string urdf =
      Replaced(ArmedUrdf({{"b_3", Element("b_1", 2, 0)}}), "effort=\"50\"/>" + Element("b_1", 2, 0),
               "effort=\"0\"/>" + Element("b_1", 2, 0));
  EXPECT_EQ(MimicMessageOf(ArmedYaml(), urdf), "no error");
}

struct BadCoupling {
  std::string what;
  std::map<std::string, std::string> mimics;
  std::string posture;
  std::string lump;
  std::string message;
};

void PrintTo(const BadCoupling& bad, std::ostream* stream) { *stream << bad.what; }

class MimicErrors : public ::testing::TestWithParam<BadCoupling> {};

TEST_P(MimicErrors, EachFaultIsNamedInOneLine) {
  const BadCoupling& bad = GetParam();
  EXPECT_EQ(MimicMessageOf(ArmedYaml(bad.posture, bad.lump), ArmedUrdf(bad.mimics)), bad.message);
}

const BadCoupling kBadCouplings[] = {
    {"UnknownMaster",
     {{"a_3", Element("b_4", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: unknown joint 'b_4' (did you mean 'b_1'?)"},
    {"NoMaster",
     {{"a_3", "<mimic multiplier=\"2\"/>"}},
     "",
     "",
     "robot.urdf: not a valid URDF: joint mimic: no mimic joint specified; Could not parse mimic "
     "element for joint [a_3]"},
    {"Itself",
     {{"a_3", Element("a_3", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: it follows joints in a circle, by way of 'a_3'"},
    {"Circle",
     {{"a_1", Element("a_3", 1, 0)}, {"a_3", Element("b_1", 1, 0)}, {"b_1", Element("a_1", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_1': mimic: it follows joints in a circle, by way of 'a_1'"},
    {"IntoACircle",
     {{"a_1", Element("a_3", 1, 0)}, {"a_3", Element("b_1", 1, 0)}, {"b_1", Element("a_3", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_1': mimic: it follows joints in a circle, by way of 'a_3'"},
    {"MultiplierZero",
     {{"a_3", Element("b_1", 0, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: expected a multiplier of 1e-06 to 1e+06 in magnitude, got 0"},
    {"ChainTooSmall",
     {{"a_3", Element("b_3", 1e-4, 0)}, {"b_3", Element("b_1", -1e-4, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: expected a multiplier of 1e-06 to 1e+06 in magnitude, "
     "got -1e-08"},
    {"OffsetTooLarge",
     {{"a_3", Element("b_3", 1e5, 0)}, {"b_3", Element("b_1", 1, 100)}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: expected an offset of at most 1e+06 in magnitude, got "
     "10000000"},
    {"MultiplierNaN",
     {{"a_3", "<mimic joint=\"b_1\" multiplier=\"nan\"/>"}},
     "",
     "",
     "robot.urdf: not a valid URDF: multiplier value (nan) is not a valid float; Could not parse "
     "mimic element for joint [a_3]"},
    {"OffsetInfinite",
     {{"a_3", "<mimic joint=\"b_1\" offset=\"inf\"/>"}},
     "",
     "",
     "robot.urdf: not a valid URDF: offset value (inf) is not a valid float; Could not parse mimic "
     "element for joint [a_3]"},
    {"MultiplierNoNumber",
     {{"a_3", "<mimic joint=\"b_1\" multiplier=\"two\"/>"}},
     "",
     "",
     "robot.urdf: not a valid URDF: multiplier value (two) is not a valid float; Could not parse "
     "mimic element for joint [a_3]"},
    {"MultiplierHuge",
     {{"a_3", "<mimic joint=\"b_1\" multiplier=\"1e300\"/>"}},
     "",
     "",
     "robot.urdf: joint 'a_3': mimic: expected numbers of at most 1e6 in magnitude, got 1e+300"},
    {"FixedMimics",
     {{"a_fixed", Element("b_1", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'a_fixed': mimic: a fixed joint cannot mimic another one"},
    {"FixedMaster",
     {{"b_3", Element("a_fixed", 1, 0)}},
     "",
     "",
     "robot.urdf: joint 'b_3': mimic: joint 'a_fixed' is fixed"},
    {"LumpedMaster",
     {{"a_3", Element("b_1", 1, 0)}},
     "",
     "b_1",
     "robot.urdf: joint 'a_3': mimic: joint 'b_1' is lumped, expected 'a_3' to be lumped as well"},
    {"LimitsContradict",
     {{"a_1", Element("b_1", 1, 3)}},
     "",
     "",
     "robot.urdf: joint 'a_1': mimic: its limits want joint 'b_1' within -3.5 to -1, which "
     "contradicts -0.5 to 2"},
    {"LimitsOfTwoContradict",
     {{"a_1", Element("b_1", 1, 1)}, {"a_2", Element("b_1", 1, -2)}},
     "",
     "",
     "robot.urdf: joint 'a_2': mimic: its limits want joint 'b_1' within 1.5 to 4, which "
     "contradicts -0.5 to 1"},
    {"PostureContradicts",
     {{"a_3", Element("b_1", 2, 0)}},
     ", b_1: 10, a_3: 21",
     "",
     "robot.yaml:19: gaits[0].posture.joints_deg.a_3: expected 20, which follows from joint 'b_1', "
     "got 21"},
    {"PostureOfTheMimicAlone",
     {{"a_3", Element("b_1", 2, 0)}},
     ", a_3: 20",
     "",
     "robot.yaml:19: gaits[0].posture.joints_deg.a_3: expected 0, which follows from joint 'b_1', "
     "got 20"},
    {"PostureBeyondLimits",
     {{"a_1", Element("b_1", -1, 0)}},
     ", b_1: 90",
     "",
     "robot.yaml:19: gaits[0].posture.joints_deg: joint 'a_1' follows 'b_1' to -90, outside its "
     "limits -28.6479 to 114.592"},
    {"MimickedLimb",
     {{"a_3", Element("l_roll", 1, 0)}},
     "",
     "",
     "robot.yaml:21: gaits[0].limbs[0].joints[1]: joint 'l_roll' is mimicked by another, expected "
     "an uncoupled joint"},
};

INSTANTIATE_TEST_SUITE_P(Couplings, MimicErrors, ::testing::ValuesIn(kBadCouplings),
                         [](const auto& info) { return info.param.what; });

TEST(MotorTorques, OfMimicsActThroughTheirMasters) {
  RobotModel robot;
  robot.joints.resize(4);
  robot.joints[0].mimic = {2, -0.5, 0};
  robot.joints[3].mimic = {2, 2, 0.1};
  const Eigen::VectorXd motors = MotorTorques(robot, Eigen::Vector4d(10, 20, 30, 40));
  EXPECT_EQ(motors, Eigen::VectorXd(Eigen::Vector4d(0, 20, 30 - 5 + 80, 0)));
}

}  // namespace
}  // namespace possibility::models
