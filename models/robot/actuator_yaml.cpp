#include "models/robot/actuator_yaml.h"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "models/input/named_lookup.h"

namespace possibility::models {
namespace {

/// rad/s or m/s. A sharper change of sign would make a motion too stiff to integrate.
constexpr double kLeastDrySpeed = 1e-3;
constexpr double kGreatest = 1e6;

std::optional<TorqueSpeedLine> ReadLine(const YamlNode& node) {
  const auto torque = node.Find("stall_torque");
  const auto speed = node.Find("no_load_speed");
  if (!torque && !speed) return std::nullopt;
  if (!torque || !speed) node.Fail("expected both stall_torque and no_load_speed or neither");
  return TorqueSpeedLine{torque->Positive(), speed->Positive()};
}

Actuator ReadActuator(const YamlNode& node) {
  node.MapOf({"joints", "armature", "viscous_friction", "dry_friction", "dry_speed", "stall_torque",
              "no_load_speed", "reason"});
  node.At("reason").String();
  Actuator actuator;
  if (const auto value = node.Find("armature")) actuator.armature = value->NonNegative();
  if (const auto value = node.Find("viscous_friction")) {
    actuator.viscous_friction = value->NonNegative();
  }
  if (const auto value = node.Find("dry_friction")) actuator.dry_friction = value->NonNegative();
  if (const auto value = node.Find("dry_speed")) {
    if (!node.Find("dry_friction")) value->Fail("expected dry_friction beside it");
    actuator.dry_speed = value->Number(kLeastDrySpeed, kGreatest);
  }
  actuator.line = ReadLine(node);
  const bool says_something = node.Find("armature") || node.Find("viscous_friction") ||
                              node.Find("dry_friction") || actuator.line;
  if (!says_something) {
    node.Fail("expected at least one of armature, viscous_friction, dry_friction, stall_torque");
  }
  return actuator;
}

void CheckJoint(const Joint& joint, const Actuator& actuator, const RobotModel& robot,
                const YamlNode& node) {
  if (joint.mimic) {
    node.At("joints").Fail(fmt::format("joint '{}' mimics '{}', whose actuator counts for both",
                                       joint.name, robot.joints[joint.mimic->joint].name));
  }
  if (!actuator.line) return;
  if (!(actuator.line->stall_torque >= joint.effort)) {
    node.At("stall_torque")
        .Fail(fmt::format("expected at least the torque limit of joint '{}', {}, got {}",
                          joint.name, joint.effort, actuator.line->stall_torque));
  }
  if (!(actuator.line->no_load_speed > joint.velocity)) {
    node.At("no_load_speed")
        .Fail(fmt::format("expected more than the speed limit of joint '{}', {}, got {}",
                          joint.name, joint.velocity, actuator.line->no_load_speed));
  }
}

}  // namespace

void ReadActuators(const YamlNode& list, RobotModel* robot) {
  std::set<int> seen;
  for (const YamlNode& node : list.Items()) {
    const Actuator actuator = ReadActuator(node);
    for (const int index : IndicesOfNamed(node.At("joints"), robot->joints, "joint")) {
      Joint& joint = robot->joints[index];
      if (!seen.insert(index).second) {
        node.At("joints").Fail(fmt::format("joint '{}' is listed twice", joint.name));
      }
      CheckJoint(joint, actuator, *robot, node);
      joint.actuator = actuator;
    }
  }
}

}  // namespace possibility::models
