#pragma once

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {

/// Grows a robot that is its own mirror image in y = 0 (mass properties may be left asymmetric).
/// Link frames are turned at random, so that nothing is symmetric in the links' own axes.
class SymmetricRobotBuilder {
 public:
  explicit SymmetricRobotBuilder(std::mt19937* random, bool symmetric_masses = true)
      : random_(random), symmetric_masses_(symmetric_masses) {
    model_.name = "random symmetric robot";
    model_.friction = 0.7;
    model_.links.resize(1);
    model_.links[0].name = "root";
    model_.links[0].inertial = RandomInertial(random);
    poses_.push_back(Eigen::Isometry3d::Identity());
  }

  /// A joint of the middle, on `parent`; returns its link.
  int AddMiddle(int parent, models::JointType type, const Eigen::Vector3d& axis_W) {
    Eigen::Vector3d origin = poses_[parent].translation() + RandomVector(random_, 3, 0.3);
    origin.y() = 0;
    return AddJoint("middle", parent, type, axis_W, origin, RandomInertial(random_));
  }

  /// A pair of joints, the left one's parent `left` and the right one's `right`; returns their
  /// links. The axis (world, left) is mirrored, with a random sign.
  std::pair<int, int> AddPair(int left, int right, models::JointType type,
                              const Eigen::Vector3d& axis_W) {
    Eigen::Vector3d origin = poses_[left].translation() + RandomVector(random_, 3, 0.3);
    origin.y() = std::abs(origin.y()) + 0.02;
    const models::Inertial inertial = RandomInertial(random_);
    const bool slides = type == models::JointType::kPrismatic;
    const double sign = ((*random_)() % 2 == 0 ? 1 : -1);
    const int l = AddJoint("left", left, type, axis_W, origin, inertial);
    const Eigen::Vector3d axis = sign * (slides ? Mirrored(axis_W) : -Mirrored(axis_W));
    const int r = AddJoint("right", right, type, axis, Mirrored(origin), inertial);
    model_.links[r].inertial = symmetric_masses_ ? MirroredInertial(l, r) : RandomInertial(random_);
    models::Joint& right_joint = model_.joints[r - 1];
    const models::Joint& left_joint = model_.joints[l - 1];
    if (sign < 0) {
      right_joint.lower = -left_joint.upper;
      right_joint.upper = -left_joint.lower;
    }
    model_.sagittal_pairs.emplace_back(l - 1, r - 1);
    return {l, r};
  }

  /// `points` of the left link in world axes at rest, relative to its origin.
  void AddContacts(int left, int right, const std::vector<Eigen::Vector3d>& points) {
    models::ContactPatch l{"left contact " + std::to_string(left), left, {}, {}};
    models::ContactPatch r{"right contact " + std::to_string(left), right, {}, {}};
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d p_W = poses_[left].translation() + p;
      l.points.push_back(poses_[left].inverse() * p_W);
      r.points.push_back(poses_[right].inverse() * Mirrored(p_W));
    }
    l.normal_L = -(poses_[left].linear().transpose() * Eigen::Vector3d::UnitZ());
    r.normal_L = -(poses_[right].linear().transpose() * Eigen::Vector3d::UnitZ());
    model_.contacts.push_back(l);
    model_.contacts.push_back(r);
  }

  models::RobotModel& model() { return model_; }

  static Eigen::Vector3d Mirrored(const Eigen::Vector3d& v) { return {v.x(), -v.y(), v.z()}; }

 private:
  int AddJoint(const std::string& side, int parent, models::JointType type,
               const Eigen::Vector3d& axis_W, const Eigen::Vector3d& origin,
               const models::Inertial& inertial) {
    Eigen::Isometry3d X_WL = RandomPose(random_, 0);
    X_WL.translation() = origin;
    models::Joint joint;
    joint.name = side + " joint " + std::to_string(model_.num_joints());
    joint.type = type;
    joint.parent = parent;
    joint.X_PJ = poses_[parent].inverse() * X_WL;
    joint.axis = (X_WL.linear().transpose() * axis_W).normalized();
    joint.lower = -1;
    joint.upper = 2;
    joint.velocity = 10;
    joint.effort = Uniform(random_, 20, 200);
    model_.joints.push_back(joint);
    model_.links.push_back({side + " link " + std::to_string(model_.num_links()), inertial, {}});
    poses_.push_back(X_WL);
    return model_.num_links() - 1;
  }

  models::Inertial MirroredInertial(int left, int right) const {
    const Eigen::Matrix3d mirror = Eigen::Vector3d(1, -1, 1).asDiagonal();
    const models::Inertial& l = model_.links[left].inertial;
    const Eigen::Matrix3d to_right =
        poses_[right].linear().transpose() * mirror * poses_[left].linear();
    models::Inertial r;
    r.mass = l.mass;
    r.p_LC = to_right * l.p_LC;
    r.I_LC = to_right * l.I_LC * to_right.transpose();
    r.I_LC = (r.I_LC + r.I_LC.transpose()).eval() / 2;
    return r;
  }

  std::mt19937* random_;
  bool symmetric_masses_;
  models::RobotModel model_;
  std::vector<Eigen::Isometry3d> poses_;
};

inline Eigen::Vector3d RandomInPlane(std::mt19937* random) {
  const double angle = Uniform(random, 0, 2 * M_PI);
  return {std::cos(angle), 0, std::sin(angle)};
}

/// A spine and two pairs of limbs with every kind of joint, free in the plane and locked.
inline models::RobotModel RandomSymmetricRobot(std::mt19937* random, bool symmetric_masses = true) {
  using models::JointType;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  SymmetricRobotBuilder builder(random, symmetric_masses);
  if (symmetric_masses) {
    // The root's products of inertia and offset across the plane.
    models::Inertial& root = builder.model().links[0].inertial;
    root.p_LC.y() = 0;
    root.I_LC(0, 1) = root.I_LC(1, 0) = root.I_LC(1, 2) = root.I_LC(2, 1) = 0;
  }
  int spine = 0;
  if (!symmetric_masses) {
    spine = builder.AddMiddle(spine, JointType::kRevolute, Eigen::Vector3d::UnitZ());
    spine = builder.AddMiddle(spine, JointType::kRevolute, -y);
    builder.AddMiddle(spine, JointType::kPrismatic, RandomInPlane(random));
  }
  for (const int trunk : {0, spine}) {
    std::pair<int, int> links{trunk, trunk};
    const int depth = 3 + static_cast<int>((*random)() % 4);
    for (int i = 0; i < depth; ++i) {
      switch ((*random)() % 5) {
        case 0:
          links = builder.AddPair(links.first, links.second, JointType::kPrismatic,
                                  RandomInPlane(random));
          break;
        case 1:
          links = builder.AddPair(links.first, links.second, JointType::kRevolute,
                                  RandomVector(random, 3, 1).normalized());
          break;
        default:
          links = builder.AddPair(links.first, links.second, JointType::kRevolute,
                                  (*random)() % 2 == 0 ? y : Eigen::Vector3d(-y));
      }
    }
    const double x = Uniform(random, 0.05, 0.2);
    builder.AddContacts(links.first, links.second,
                        {{x, 0.05, -0.1}, {x, -0.05, -0.1}, {-x, -0.05, -0.1}, {-x, 0.05, -0.1}});
  }
  return builder.model();
}

}  // namespace possibility::dynamics
