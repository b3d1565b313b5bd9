#include "models/robot/gait_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "models/input/action_name.h"
#include "models/input/named_lookup.h"
#include "models/robot/mimic_joints.h"

namespace possibility::models {
namespace {

constexpr double kGroundTolerance = 1e-4;  // m

/// A joint's value in the file's units: degrees, or metres if prismatic.
double ReadJointValue(const YamlNode& node, const Joint& joint) {
  const double value = joint.type == JointType::kPrismatic ? node.Number() : node.Degrees();
  constexpr double kRounding = 1e-9;
  if (value < joint.lower - kRounding || value > joint.upper + kRounding) {
    const double unit = joint.type == JointType::kPrismatic ? 1 : 180 / std::numbers::pi;
    node.FailExpected(fmt::format("a value within the limits {:.6g} to {:.6g} of joint '{}'",
                                  joint.lower * unit, joint.upper * unit, joint.name));
  }
  return value;
}

std::map<int, double> ReadJointValues(const YamlNode& node, const RobotModel& robot) {
  std::vector<std::string> names;
  for (const Joint& joint : robot.joints) names.push_back(joint.name);
  node.MapOf(names);
  std::map<int, double> values;
  for (const auto& [name, value] : node.Entries()) {
    const int joint = robot.JointIndex(name);
    values[joint] = ReadJointValue(value, robot.joints[joint]);
  }
  return values;
}

/// Mimic joints follow their masters, whether or not the file gives them values as well.
void CompleteMimicJoints(const YamlNode& node, const std::map<int, double>& given,
                         const RobotModel& robot, Eigen::VectorXd* joints) {
  FollowMasters(robot, joints);
  constexpr double kTolerance = 1e-6;  // rad or m; files give degrees with a few digits
  for (int i = 0; i < robot.num_joints(); ++i) {
    const Joint& joint = robot.joints[i];
    if (!joint.mimic) continue;
    const double value = (*joints)[i];
    const double unit = joint.type == JointType::kPrismatic ? 1 : 180 / std::numbers::pi;
    const std::string& master = robot.joints[joint.mimic->joint].name;
    const auto own = given.find(i);
    if (own != given.end() && !(std::abs(own->second - value) <= kTolerance)) {
      node.At(joint.name)
          .FailExpected(fmt::format("{:.6g}, which follows from joint '{}'", value * unit, master));
    }
    if (value < joint.lower - kTolerance || value > joint.upper + kTolerance) {
      node.Fail(
          fmt::format("joint '{}' follows '{}' to {:.6g}, outside its limits {:.6g} to {:.6g}",
                      joint.name, master, value * unit, joint.lower * unit, joint.upper * unit));
    }
  }
}

void CheckRestIsAllowed(const YamlNode& node, const Posture& posture, const RobotModel& robot) {
  for (int i = 0; i < robot.num_joints(); ++i) {
    const Joint& joint = robot.joints[i];
    if (posture.joints[i] == 0 && (joint.lower > 0 || joint.upper < 0)) {
      node.Fail(fmt::format("joint '{}' must be given: 0 is outside its limits", joint.name));
    }
  }
}

Posture ReadPosture(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"root_height", "root_pitch_deg", "joints_deg"});
  Posture posture;
  posture.root_height = node.At("root_height").Positive();
  posture.root_pitch = node.At("root_pitch_deg").Degrees();
  posture.joints = Eigen::VectorXd::Zero(robot.num_joints());
  const std::map<int, double> given = ReadJointValues(node.At("joints_deg"), robot);
  for (const auto& [joint, value] : given) posture.joints[joint] = value;
  CompleteMimicJoints(node.At("joints_deg"), given, robot, &posture.joints);
  CheckRestIsAllowed(node.At("joints_deg"), posture, robot);
  return posture;
}

/// Gaits move joints one by one, which coupled joints do not allow.
void CheckUncoupled(const YamlNode& node, int joint, const RobotModel& robot) {
  if (!robot.IsCoupled(joint)) return;
  const auto& mimic = robot.joints[joint].mimic;
  node.Fail(fmt::format("joint '{}' {}, expected an uncoupled joint", robot.joints[joint].name,
                        mimic ? "mimics '" + robot.joints[mimic->joint].name + "'"
                              : std::string("is mimicked by another")));
}

bool Moves(const RobotModel& robot, int joint, int link) {
  while (link > 0 && link != joint + 1) link = robot.joints[link - 1].parent;
  return link == joint + 1;
}

GaitLimb ReadLimb(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"contact", "hold_orientation", "joints"});
  GaitLimb limb;
  limb.contact = IndexOfNamed(node.At("contact"), robot.contacts, "contact");
  limb.hold_orientation = node.At("hold_orientation").Boolean();
  const YamlNode joints = node.At("joints");
  limb.joints = IndicesOfNamed(joints, robot.joints, "joint");
  const std::size_t rows = limb.hold_orientation ? 6 : 3;
  if (limb.joints.size() != rows) {
    joints.Fail(fmt::format("expected {} joints to hold {}, got {}", rows,
                            limb.hold_orientation ? "a pose" : "a point", limb.joints.size()));
  }
  for (const YamlNode& joint : joints.Items()) {
    CheckUncoupled(joint, robot.JointIndex(joint.String()), robot);
    if (!Moves(robot, robot.JointIndex(joint.String()), robot.contacts[limb.contact].link)) {
      joint.Fail(fmt::format("joint '{}' does not move contact '{}'", joint.String(),
                             robot.contacts[limb.contact].name));
    }
  }
  return limb;
}

std::vector<GaitLimb> ReadLimbs(const YamlNode& list, const RobotModel& robot) {
  std::vector<GaitLimb> limbs;
  std::set<int> contacts;
  std::set<int> joints;
  for (const YamlNode& node : list.Items()) {
    limbs.push_back(ReadLimb(node, robot));
    if (!contacts.insert(limbs.back().contact).second) {
      node.At("contact").Fail("this contact already belongs to another limb of the gait");
    }
    for (const int joint : limbs.back().joints) {
      if (joints.insert(joint).second) continue;
      node.At("joints").Fail(fmt::format("joint '{}' already belongs to another limb of the gait",
                                         robot.joints[joint].name));
    }
  }
  if (limbs.size() < 2) list.FailExpected("at least two limbs");
  return limbs;
}

GaitParameters ReadParameters(const YamlNode& node) {
  node.MapOf({"forward", "lateral", "turn_deg", "clearance", "com_margin", "swing_time",
              "com_acceleration", "minimum_shift_time", "sway_deg"});
  GaitParameters parameters;
  parameters.forward = node.At("forward").Positive();
  parameters.lateral = node.At("lateral").Positive();
  node.At("turn_deg").Positive();
  parameters.turn = node.At("turn_deg").Degrees();
  parameters.clearance = node.At("clearance").Positive();
  parameters.com_margin = node.At("com_margin").NonNegative();
  parameters.swing_time = node.At("swing_time").Positive();
  parameters.com_acceleration = node.At("com_acceleration").Positive();
  parameters.minimum_shift_time = node.At("minimum_shift_time").Positive();
  constexpr double kMostSway = 45;  // degrees
  if (const auto sway = node.Find("sway_deg")) {
    sway->Number(0, kMostSway);
    parameters.sway = sway->Degrees();
  }
  return parameters;
}

std::vector<Eigen::Isometry3d> LinkPoses(const RobotModel& robot, const Posture& posture) {
  const Eigen::VectorXd q = robot.Configuration(posture);
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size(), Eigen::Isometry3d::Identity());
  X_WL[0].linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  X_WL[0].translation() = q.segment<3>(4);
  for (int i = 0; i < robot.num_joints(); ++i) {
    const Joint& joint = robot.joints[i];
    X_WL[i + 1] = X_WL[joint.parent] * joint.X_PJ;
    if (joint.type == JointType::kPrismatic) {
      X_WL[i + 1].translate(posture.joints[i] * joint.axis);
    } else {
      X_WL[i + 1].rotate(Eigen::AngleAxisd(posture.joints[i], joint.axis));
    }
  }
  return X_WL;
}

void CheckContactsOnGround(const YamlNode& node, const Gait& gait, const RobotModel& robot) {
  const std::vector<Eigen::Isometry3d> X_WL = LinkPoses(robot, gait.posture);
  for (const GaitLimb& limb : gait.limbs) {
    const ContactPatch& contact = robot.contacts[limb.contact];
    for (const Eigen::Vector3d& point : contact.points) {
      const double height = (X_WL[contact.link] * point).z();
      if (std::abs(height) <= kGroundTolerance) continue;
      node.Fail(fmt::format("contact '{}' is at height {:.6f} m in this posture, expected 0",
                            contact.name, height));
    }
    if ((X_WL[contact.link].linear() * contact.normal_L).z() > -0.5) {
      node.Fail(fmt::format("contact '{}' does not face the ground in this posture", contact.name));
    }
  }
}

Gait ReadGait(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"name", "posture", "limbs", "parameters"});
  Gait gait;
  gait.name = ReadActionName(node.At("name"));
  gait.posture = ReadPosture(node.At("posture"), robot);
  gait.limbs = ReadLimbs(node.At("limbs"), robot);
  gait.parameters = ReadParameters(node.At("parameters"));
  CheckContactsOnGround(node.At("posture"), gait, robot);
  return gait;
}

Transition ReadTransition(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"from", "to"});
  const Gait& from = robot.gaits[IndexOfNamed(node.At("from"), robot.gaits, "gait")];
  const Gait& to = robot.gaits[IndexOfNamed(node.At("to"), robot.gaits, "gait")];
  if (&from == &to) node.At("to").FailExpected("another gait than 'from'");
  return {from.name, to.name};
}

Jump ReadJump(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"name", "from", "to"});
  const Gait& from = robot.gaits[IndexOfNamed(node.At("from"), robot.gaits, "gait")];
  const Gait& to = robot.gaits[IndexOfNamed(node.At("to"), robot.gaits, "gait")];
  const Jump jump{ReadActionName(node.At("name")), from.name, to.name};
  for (const Gait& gait : robot.gaits) {
    if (gait.name == jump.name) node.At("name").Fail("this name is already that of a gait");
  }
  return jump;
}

}  // namespace

std::vector<Gait> ReadGaits(const YamlNode& list, const RobotModel& robot) {
  std::vector<Gait> gaits;
  for (const YamlNode& node : list.Items()) {
    Gait gait = ReadGait(node, robot);
    for (const Gait& other : gaits) {
      if (other.name == gait.name) node.At("name").Fail("this name is already taken");
    }
    gaits.push_back(std::move(gait));
  }
  if (gaits.empty()) list.FailExpected("at least one gait");
  return gaits;
}

std::vector<Transition> ReadTransitions(const YamlNode& list, const RobotModel& robot) {
  std::vector<Transition> transitions;
  for (const YamlNode& node : list.Items()) {
    transitions.push_back(ReadTransition(node, robot));
    for (std::size_t i = 0; i + 1 < transitions.size(); ++i) {
      const auto pair = std::minmax(transitions[i].from, transitions[i].to);
      if (pair != std::minmax(transitions.back().from, transitions.back().to)) continue;
      node.Fail("these two gaits already have a transition (it is used in both directions)");
    }
  }
  return transitions;
}

std::vector<Jump> ReadJumps(const YamlNode& list, const RobotModel& robot) {
  std::vector<Jump> jumps;
  for (const YamlNode& node : list.Items()) {
    Jump jump = ReadJump(node, robot);
    for (const Jump& other : jumps) {
      if (other.name == jump.name) node.At("name").Fail("this name is already taken");
    }
    jumps.push_back(std::move(jump));
  }
  return jumps;
}

}  // namespace possibility::models
