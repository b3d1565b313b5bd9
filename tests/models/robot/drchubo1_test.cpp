// The model in models/drchubo1, compared with the published facts of DRC-HUBO1.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"

namespace possibility::models {
namespace {

const RobotModel& DrcHubo1() {
  static const RobotModel robot =
      LoadRobotModel(std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/drchubo1.yaml");
  return robot;
}

std::vector<Eigen::Isometry3d> LinkPoses(const RobotModel& robot, const Eigen::VectorXd& q) {
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size());
  X_WL[0] = Eigen::Translation3d(q.segment<3>(4)) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  for (int i = 0; i < robot.num_joints(); ++i) {
    const Joint& joint = robot.joints[i];
    X_WL[i + 1] = X_WL[joint.parent] * joint.X_PJ * Eigen::AngleAxisd(q[7 + i], joint.axis);
  }
  return X_WL;
}

Eigen::Vector3d CentreOfMass(const RobotModel& robot, const Eigen::VectorXd& q) {
  const std::vector<Eigen::Isometry3d> X_WL = LinkPoses(robot, q);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < robot.num_links(); ++i) {
    sum += robot.links[i].inertial.mass * (X_WL[i] * robot.links[i].inertial.p_LC);
  }
  return sum / robot.TotalMass();
}

std::vector<Eigen::Vector3d> ContactPoints(const RobotModel& robot, const std::string& contact,
                                           const Eigen::VectorXd& q) {
  const ContactPatch& patch = robot.contacts[robot.ContactIndex(contact)];
  const Eigen::Isometry3d X_WL = LinkPoses(robot, q)[patch.link];
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : patch.points) points.push_back(X_WL * point);
  return points;
}

TEST(DrcHubo1, HasThePublishedMassAndJoints) {
  const RobotModel& robot = DrcHubo1();
  EXPECT_NEAR(robot.TotalMass(), 43.985, 1e-3);
  EXPECT_EQ(robot.num_joints(), 27);
  EXPECT_EQ(robot.num_links(), 28);
  EXPECT_EQ(robot.links[0].name, "Body_TSY");
  for (int i = 0; i < robot.num_joints(); ++i) EXPECT_LE(robot.joints[i].parent, i);
}

TEST(DrcHubo1, JointsComeInThePublishedConfigurationOrder) {
  const std::vector<std::string> expected = {"LHY", "LHR", "LHP", "LKP", "LAP", "LAR", "RHY",
                                             "RHR", "RHP", "RKP", "RAP", "RAR", "TSY", "LSP",
                                             "LSR", "LSY", "LEP", "LWY", "LWP", "LWR", "RSP",
                                             "RSR", "RSY", "REP", "RWY", "RWP", "RWR"};
  std::vector<std::string> names;
  for (const Joint& joint : DrcHubo1().joints) names.push_back(joint.name);
  EXPECT_EQ(names, expected);
}

TEST(DrcHubo1, CentreOfMassAtZeroPosture) {
  const RobotModel& robot = DrcHubo1();
  Posture zero;
  zero.joints = Eigen::VectorXd::Zero(27);
  const Eigen::Vector3d com = CentreOfMass(robot, robot.Configuration(zero));
  EXPECT_LT((com - Eigen::Vector3d(0.0073, -0.0006, -0.2241)).cwiseAbs().maxCoeff(), 6e-5);
}

TEST(DrcHubo1, WalkingStanceHasThePublishedPelvisHeight) {
  const RobotModel& robot = DrcHubo1();
  const Gait& walk = robot.GaitNamed("walk");
  EXPECT_NEAR(walk.posture.root_height, 0.76662, 1e-9);
  const Eigen::VectorXd q = robot.Configuration(walk.posture);
  for (const std::string sole : {"left_sole", "right_sole"}) {
    for (const Eigen::Vector3d& point : ContactPoints(robot, sole, q)) {
      EXPECT_NEAR(point.z(), 0, 1e-5) << sole;
    }
  }
  const Eigen::Vector3d com = CentreOfMass(robot, q);
  EXPECT_LT((com - Eigen::Vector3d(0.042, -0.001, 0.617)).cwiseAbs().maxCoeff(), 6e-4);
}

// First row of the solved crawling poses: hip axis at z = 0.60, ankles at 0, pegs at -0.40 and
// centre of mass at (-0.149, 0.457) in the sagittal plane, x from the hip axis. The wrists are
// stretched by 4.2 degrees from there, and the pegs bear at the same places. That moves the centre
// of mass by 1 mm.
TEST(DrcHubo1, CrawlingPostureIsTheSolvedOne) {
  const RobotModel& robot = DrcHubo1();
  const Posture& posture = robot.GaitNamed("crawl").posture;
  EXPECT_NEAR(posture.root_pitch, -80 * M_PI / 180, 1e-12);
  const std::map<std::string, double> table = {{"HP", 34.7},  {"KP", 90.6},  {"AP", -45.3},
                                               {"SP", 110.1}, {"EP", -52.9}, {"WP", -153.5}};
  for (const auto& [family, degrees] : table) {
    for (const std::string side : {"L", "R"}) {
      EXPECT_NEAR(posture.joints[robot.JointIndex(side + family)] * 180 / M_PI, degrees, 0.051)
          << side << family;
    }
  }
  const Eigen::VectorXd q = robot.Configuration(posture);
  const std::vector<Eigen::Isometry3d> X_WL = LinkPoses(robot, q);
  const Eigen::Vector3d hip = X_WL[robot.LinkIndex("Body_LHP")].translation();
  EXPECT_NEAR(hip.z(), 0.60, 1e-3);
  for (const std::string side : {"left", "right"}) {
    const Eigen::Isometry3d& ankle =
        X_WL[robot.LinkIndex(side == "left" ? "Body_LAR" : "Body_RAR")];
    EXPECT_NEAR(ankle.translation().x() - hip.x(), 0, 1e-3);
    EXPECT_TRUE(ankle.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-6));
    for (const Eigen::Vector3d& point : ContactPoints(robot, side + "_sole", q)) {
      EXPECT_NEAR(point.z(), 0, 1e-5);
    }
    const Eigen::Vector3d peg = ContactPoints(robot, side + "_peg", q)[0];
    EXPECT_NEAR(peg.x() - hip.x(), -0.40, 1e-3);
    EXPECT_NEAR(std::abs(peg.y()), 0.2295, 1e-3);
    EXPECT_NEAR(peg.z(), 0, 1e-5);
  }
  const Eigen::Vector3d com = CentreOfMass(robot, q);
  EXPECT_NEAR(com.x() - hip.x(), -0.148, 1e-3);
  EXPECT_NEAR(com.z(), 0.457, 1e-3);
}

TEST(DrcHubo1, HasTheTransitionFromWalkingToCrawling) {
  const RobotModel& robot = DrcHubo1();
  ASSERT_EQ(robot.transitions.size(), 1u);
  EXPECT_EQ(robot.transitions[0].from, "walk");
  EXPECT_EQ(robot.transitions[0].to, "crawl");
}

TEST(DrcHubo1, PosturesAreWithinLimits) {
  const RobotModel& robot = DrcHubo1();
  std::vector<Eigen::VectorXd> postures = {Eigen::VectorXd::Zero(27)};
  for (const Gait& gait : robot.gaits) postures.push_back(gait.posture.joints);
  for (const Eigen::VectorXd& posture : postures) {
    for (int i = 0; i < 27; ++i) {
      EXPECT_GE(posture[i], robot.joints[i].lower) << robot.joints[i].name;
      EXPECT_LE(posture[i], robot.joints[i].upper) << robot.joints[i].name;
    }
  }
}

TEST(DrcHubo1, IsMirrorSymmetric) {
  const RobotModel& robot = DrcHubo1();
  EXPECT_EQ(robot.sagittal_pairs.size(), 13u);
  const Eigen::Vector3d flip(1, -1, 1);
  for (const auto& [left, right] : robot.sagittal_pairs) {
    const Joint& l = robot.joints[left];
    const Joint& r = robot.joints[right];
    EXPECT_EQ(l.name.substr(1), r.name.substr(1));
    EXPECT_LT((flip.cwiseProduct(l.X_PJ.translation()) - r.X_PJ.translation()).norm(), 1e-9);
    const bool turns_out_of_plane = std::abs(l.axis.y()) < 0.5;
    EXPECT_DOUBLE_EQ(turns_out_of_plane ? -l.upper : l.lower, r.lower) << l.name;
    EXPECT_DOUBLE_EQ(turns_out_of_plane ? -l.lower : l.upper, r.upper) << l.name;
    EXPECT_EQ(l.velocity, r.velocity);
    EXPECT_EQ(l.effort, r.effort);
    if (l.name == "LWR") continue;  // the right hand has one finger more
    const Inertial& a = robot.links[left + 1].inertial;
    const Inertial& b = robot.links[right + 1].inertial;
    EXPECT_NEAR(a.mass, b.mass, 1e-6) << l.name;
    EXPECT_LT((flip.cwiseProduct(a.p_LC) - b.p_LC).norm(), 1e-6) << l.name;
  }
}

TEST(DrcHubo1, PegsEndAtTheirContact) {
  const RobotModel& robot = DrcHubo1();
  for (const std::string name : {"left_peg", "right_peg"}) {
    const ContactPatch& peg = robot.contacts[robot.ContactIndex(name)];
    double lowest = 0;
    for (const PosedShape& posed : robot.links[peg.link].shapes) {
      if (posed.shape.type != ShapeType::kCapsule) continue;
      lowest = std::max(lowest,
                        posed.X_PS.translation().z() + posed.shape.length / 2 + posed.shape.radius);
    }
    EXPECT_NEAR(lowest, peg.points[0].z(), 1e-12) << name;
  }
}

TEST(DrcHubo1, EveryLinkHasAShape) {
  for (const Link& link : DrcHubo1().links) EXPECT_FALSE(link.shapes.empty()) << link.name;
}

}  // namespace
}  // namespace possibility::models
