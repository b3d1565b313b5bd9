#include "dynamics/tree/base_joints.h"

#include <array>
#include <limits>

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using models::JointType;

struct BaseJoint {
  const char* name;
  JointType type;
  Vector3d axis;
};

const std::array<BaseJoint, kNumBaseJoints>& BaseJoints() {
  static const std::array<BaseJoint, kNumBaseJoints> joints = {
      {{"x", JointType::kPrismatic, Vector3d::UnitX()},
       {"y", JointType::kPrismatic, Vector3d::UnitY()},
       {"z", JointType::kPrismatic, Vector3d::UnitZ()},
       {"yaw", JointType::kContinuous, Vector3d::UnitZ()},
       {"roll", JointType::kContinuous, Vector3d::UnitX()},
       {"pitch", JointType::kContinuous, Vector3d::UnitY()}}};
  return joints;
}

models::Joint Unlimited(const BaseJoint& base, int parent) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  models::Joint joint;
  joint.name = base.name;
  joint.type = base.type;
  joint.parent = parent;
  joint.axis = base.axis;
  joint.lower = -kUnlimited;
  joint.upper = joint.velocity = joint.effort = kUnlimited;
  return joint;
}

}  // namespace

models::RobotModel OnBaseJoints(const models::RobotModel& robot) {
  models::RobotModel tree;
  tree.name = robot.name + "_on_joints";
  tree.file = robot.file;
  tree.content_hash = robot.content_hash;
  tree.friction = robot.friction;
  tree.links.resize(kNumBaseJoints);
  tree.links[0].name = "world";
  for (int i = 0; i < kNumBaseJoints; ++i) {
    tree.joints.push_back(Unlimited(BaseJoints()[i], i));
    if (i > 0) tree.links[i].name = BaseJoints()[i - 1].name;
  }
  tree.links.insert(tree.links.end(), robot.links.begin(), robot.links.end());
  for (models::Joint joint : robot.joints) {
    joint.parent += kNumBaseJoints;
    if (joint.mimic) joint.mimic->joint += kNumBaseJoints;
    tree.joints.push_back(joint);
  }
  for (models::ContactPatch patch : robot.contacts) {
    patch.link += kNumBaseJoints;
    tree.contacts.push_back(patch);
  }
  tree.pelvis_shape_link = robot.pelvis_shape_link + kNumBaseJoints;
  return tree;
}

}  // namespace possibility::dynamics
