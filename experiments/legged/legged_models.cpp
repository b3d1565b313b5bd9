#include "experiments/legged/legged_models.h"

#include <limits>
#include <string>

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;

/// A rod in the plane: centre of mass at height `com` in its frame, moment of inertia about y.
models::Link Rod(const std::string& name, double mass, double com, double inertia) {
  models::Link link;
  link.name = name;
  link.inertial.mass = mass;
  link.inertial.p_LC = com * Vector3d::UnitZ();
  link.inertial.I_LC = inertia * Eigen::Matrix3d::Identity();
  return link;
}

/// About +y, at height `at` in the parent's frame.
models::Joint Hinge(const std::string& name, int parent, double at, double lower, double upper,
                    double effort) {
  models::Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.X_PJ.translation() = at * Vector3d::UnitZ();
  joint.axis = Vector3d::UnitY();
  joint.lower = lower;
  joint.upper = upper;
  joint.velocity = 20;
  joint.effort = effort;
  return joint;
}

constexpr double kSegment = 0.4;  // m, each of the biped's shanks and thighs

}  // namespace

models::RobotModel FiveLinkBiped() {
  constexpr double kShankMass = 3.2, kThighMass = 6.8, kTorsoMass = 20;
  constexpr double kShankInertia = 0.93, kThighInertia = 1.08, kTorsoInertia = 2.22;
  constexpr double kKneeToShank = 0.128, kHipToThigh = 0.163, kHipToTorso = 0.625 - 0.2;
  constexpr double kTurn = 2;  // rad, more than any step needs
  constexpr double kEffort = 100;
  models::RobotModel robot;
  robot.name = "five-link biped";
  robot.links = {Rod("stance_shank", kShankMass, kSegment - kKneeToShank, kShankInertia),
                 Rod("stance_thigh", kThighMass, kSegment - kHipToThigh, kThighInertia),
                 Rod("torso", kTorsoMass, kHipToTorso, kTorsoInertia),
                 Rod("swing_thigh", kThighMass, -kHipToThigh, kThighInertia),
                 Rod("swing_shank", kShankMass, -kKneeToShank, kShankInertia)};
  robot.joints = {Hinge("stance_knee", 0, kSegment, -kTurn, kTurn, kEffort),
                  Hinge("stance_hip", 1, kSegment, -kTurn, kTurn, kEffort),
                  Hinge("swing_hip", 2, 0, -kTurn, kTurn, kEffort),
                  Hinge("swing_knee", 3, -kSegment, -kTurn, kTurn, kEffort)};
  return robot;
}

Vector3d SwingFoot() { return -kSegment * Vector3d::UnitZ(); }

models::RobotModel Hopper() {
  models::RobotModel robot;
  robot.name = "hopper";
  robot.links = {Rod("foot_tube", 1, 0.2, 0.02), Rod("hip_block", 1, 0, 0.01),
                 Rod("body", 10, 0.1, 0.5)};
  models::Joint leg = Hinge("leg", 0, 0, 0.3, 0.7, 600);
  leg.type = models::JointType::kPrismatic;
  leg.axis = Vector3d::UnitZ();
  robot.joints = {leg, Hinge("hip", 1, 0, -1.2, 1.2, 100)};
  return robot;
}

}  // namespace possibility::experiments
