#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <random>
#include <string>

#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"

namespace possibility::dynamics {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline models::RobotModel DrcHubo() {
  return models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
}

inline double Uniform(std::mt19937* random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(*random);
}

inline Eigen::VectorXd RandomVector(std::mt19937* random, int size, double bound) {
  Eigen::VectorXd v(size);
  for (double& x : v) x = Uniform(random, -bound, bound);
  return v;
}

inline Eigen::Isometry3d RandomPose(std::mt19937* random, double distance) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Eigen::Vector4d q = RandomVector(random, 4, 1);
  X.linear() = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  X.translation() = RandomVector(random, 3, distance);
  return X;
}

/// A solid ellipsoid at a random place near the link's origin.
inline models::Inertial RandomInertial(std::mt19937* random) {
  models::Inertial inertial;
  inertial.mass = Uniform(random, 0.5, 8);
  inertial.p_LC = RandomVector(random, 3, 0.2);
  const Eigen::Vector3d squares = RandomVector(random, 3, 0.2).array().square() + 0.0025;
  const Eigen::Matrix3d R = RandomPose(random, 0).linear();
  const Eigen::Vector3d moments =
      inertial.mass / 5 *
      Eigen::Vector3d(squares.y() + squares.z(), squares.z() + squares.x(),
                      squares.x() + squares.y());
  const Eigen::Matrix3d I = R * moments.asDiagonal() * R.transpose();
  inertial.I_LC = (I + I.transpose()) / 2;
  return inertial;
}

/// A tree of random shape with every kind of joint.
inline models::RobotModel RandomTree(std::mt19937* random, int num_joints) {
  models::RobotModel model;
  model.name = "random tree";
  model.links.resize(num_joints + 1);
  for (models::Link& link : model.links) link.inertial = RandomInertial(random);
  for (int i = 0; i < num_joints; ++i) {
    models::Joint joint;
    joint.name = "joint " + std::to_string(i);
    const int kind = static_cast<int>((*random)() % 4);
    joint.type = kind == 0   ? models::JointType::kPrismatic
                 : kind == 1 ? models::JointType::kContinuous
                             : models::JointType::kRevolute;
    // Mostly chains, with an occasional branch.
    joint.parent = (*random)() % 3 == 0 ? static_cast<int>((*random)() % (i + 1)) : i;
    joint.X_PJ = RandomPose(random, 0.3);
    const Eigen::Vector3d direction = RandomVector(random, 3, 1);
    joint.axis = direction.normalized();
    joint.lower = -2;
    joint.upper = 2;
    joint.velocity = 10;
    joint.effort = 500;
    model.joints.push_back(joint);
  }
  return model;
}

/// The same robot with rotors, friction and torque-speed lines at some joints that mimic no other.
inline models::RobotModel WithActuators(models::RobotModel model, std::mt19937* random) {
  for (models::Joint& joint : model.joints) {
    if (joint.mimic) continue;
    models::Actuator& actuator = joint.actuator;
    if ((*random)() % 3 != 0) actuator.armature = Uniform(random, 0.01, 2);
    if ((*random)() % 3 != 0) actuator.viscous_friction = Uniform(random, 0.1, 5);
    if ((*random)() % 3 != 0) actuator.dry_friction = Uniform(random, 0.1, 5);
    actuator.dry_speed = Uniform(random, 1, 3);
    if ((*random)() % 3 != 0) actuator.line = models::TorqueSpeedLine{600, 12};
  }
  return model;
}

/// A tree in the plane y = 0 with turning and sliding joints.
inline models::RobotModel RandomPlanarTree(std::mt19937* random, int num_joints) {
  models::RobotModel tree = RandomTree(random, num_joints);
  for (models::Joint& joint : tree.joints) {
    const bool slides = joint.type == models::JointType::kPrismatic;
    const double tilt = Uniform(random, -3, 3);
    joint.X_PJ = Eigen::Translation3d(Uniform(random, -0.3, 0.3), 0, Uniform(random, -0.3, 0.3)) *
                 Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY());
    joint.axis = slides ? Eigen::Vector3d(0.6, 0, 0.8) : Eigen::Vector3d(0, tilt > 0 ? 1 : -1, 0);
  }
  return tree;
}

inline Eigen::VectorXd RandomConfiguration(std::mt19937* random, const models::RobotModel& model) {
  Eigen::VectorXd q = RandomVector(random, model.nq(), 2);
  q.head<4>().normalize();
  return q;
}

/// The configuration after moving along constant v for time t; `v` as in RobotModel.
inline Eigen::VectorXd Moved(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) {
  Eigen::VectorXd moved = q;
  const double angle = v.head<3>().norm() * t;
  if (angle != 0) {
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(angle, Eigen::Vector3d(v.head<3>()).normalized()));
    const Eigen::Quaterniond after = turn * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    moved.head<4>() << after.w(), after.x(), after.y(), after.z();
  }
  moved.tail(q.size() - 4) += t * v.tail(v.size() - 3);
  return moved;
}

}  // namespace possibility::dynamics
