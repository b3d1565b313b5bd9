#include "dynamics/tree/multibody_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/robot/rotation_vector.h"

namespace possibility::dynamics {

namespace {

using Eigen::VectorXd;

constexpr int kPitch = 1;  // index into a tree's velocity: angular about +y
constexpr int kX = 3;
constexpr int kZ = 5;

void CheckSize(const char* what, Eigen::Index actual, int expected) {
  if (actual == expected) return;
  throw std::invalid_argument(
      fmt::format("MultibodyModel: {} has {} elements, expected {}", what, actual, expected));
}

/// Checks that the tree stays in the plane y = 0 for all joint values.
void CheckPlanar(const models::RobotModel& tree) {
  constexpr double kTolerance = 1e-9;
  std::vector<Eigen::Matrix3d> R_WL(tree.num_links(), Eigen::Matrix3d::Identity());
  for (int i = 0; i < tree.num_joints(); ++i) {
    const models::Joint& joint = tree.joints[i];
    R_WL[i + 1] = R_WL[joint.parent] * joint.X_PJ.linear();
    const double along_y = std::abs((R_WL[i + 1] * joint.axis).y());
    const bool slides = joint.type == models::JointType::kPrismatic;
    if (std::abs(along_y - (slides ? 0.0 : 1.0)) > kTolerance) {
      throw std::invalid_argument(
          fmt::format("MultibodyModel: joint '{}' leaves the plane y = 0", joint.name));
    }
  }
}

}  // namespace

std::shared_ptr<const MultibodyModel> MultibodyModel::Spatial(const models::RobotModel& robot) {
  return std::shared_ptr<const MultibodyModel>(new MultibodyModel(robot, Base::kFloating));
}

std::shared_ptr<const MultibodyModel> MultibodyModel::Planar(const models::RobotModel& tree) {
  CheckPlanar(tree);
  return std::shared_ptr<const MultibodyModel>(new MultibodyModel(tree, Base::kPlanar));
}

MultibodyModel::MultibodyModel(models::RobotModel tree, Base base)
    : tree_(std::move(tree)), base_(base) {
  CoupleJoints();
  CombineLimits();
}

void MultibodyModel::CoupleJoints() {
  std::vector<int> independent(tree_.num_joints(), -1);
  for (int j = 0; j < tree_.num_joints(); ++j) {
    if (tree_.joints[j].mimic) continue;
    independent[j] = static_cast<int>(joints_.size());
    joints_.push_back(j);
  }
  couplings_.resize(tree_.nv());
  if (base_ == Base::kFloating) {
    for (int i = 0; i < 6; ++i) couplings_[i].independent = i;
  } else {
    couplings_[kPitch].independent = 0;
    couplings_[kX].independent = 1;
    couplings_[kZ].independent = 2;
  }
  offsets_ = VectorXd::Zero(tree_.num_joints());
  for (int j = 0; j < tree_.num_joints(); ++j) {
    const auto& mimic = tree_.joints[j].mimic;
    const int master = mimic ? mimic->joint : j;
    if (master < 0 || master >= tree_.num_joints() || independent[master] < 0) {
      throw std::invalid_argument(fmt::format(
          "MultibodyModel: joint '{}' mimics no independent joint", tree_.joints[j].name));
    }
    couplings_[6 + j] = {num_base_velocities() + independent[master],
                         mimic ? mimic->multiplier : 1.0};
    if (mimic) offsets_[j] = mimic->offset;
  }
  is_identity_ = base_ == Base::kFloating && num_joints() == tree_.num_joints();
}

void MultibodyModel::CombineLimits() {
  const int n = num_joints();
  lower_.resize(n);
  upper_.resize(n);
  velocity_.resize(n);
  effort_.resize(n);
  for (int i = 0; i < n; ++i) {
    const models::Joint& joint = tree_.joints[joints_[i]];
    lower_[i] = joint.lower;
    upper_[i] = joint.upper;
    velocity_[i] = joint.velocity;
    effort_[i] = joint.effort;
  }
  for (int j = 0; j < tree_.num_joints(); ++j) {
    const models::Joint& joint = tree_.joints[j];
    if (!joint.mimic) continue;
    const int i = couplings_[6 + j].independent - num_base_velocities();
    const double factor = joint.mimic->multiplier;
    const double a = (joint.lower - joint.mimic->offset) / factor;
    const double b = (joint.upper - joint.mimic->offset) / factor;
    lower_[i] = std::max(lower_[i], std::min(a, b));
    upper_[i] = std::min(upper_[i], std::max(a, b));
    velocity_[i] = std::min(velocity_[i], joint.velocity / std::abs(factor));
  }
}

VectorXd MultibodyModel::TreeConfiguration(const Eigen::Ref<const VectorXd>& q) const {
  CheckSize("q", q.size(), nq());
  VectorXd tree(tree_.nq());
  if (base_ == Base::kFloating) {
    tree.head<7>() = q.head<7>();
  } else {
    tree.head<7>() << std::cos(q[0] / 2), 0, std::sin(q[0] / 2), 0, q[1], 0, q[2];
  }
  const int shift = num_base_positions() - num_base_velocities();
  for (int j = 0; j < tree_.num_joints(); ++j) {
    const CoupledVelocity& coupling = couplings_[6 + j];
    tree[7 + j] = coupling.factor * q[coupling.independent + shift] + offsets_[j];
  }
  return tree;
}

VectorXd MultibodyModel::TreeVelocity(const Eigen::Ref<const VectorXd>& v) const {
  CheckSize("v", v.size(), nv());
  VectorXd tree(tree_.nv());
  for (int i = 0; i < tree_.nv(); ++i) {
    const CoupledVelocity& coupling = couplings_[i];
    tree[i] = coupling.independent < 0 ? 0.0 : coupling.factor * v[coupling.independent];
  }
  return tree;
}

VectorXd MultibodyModel::IndependentForces(const Eigen::Ref<const VectorXd>& tree_forces) const {
  CheckSize("a generalised force of the tree", tree_forces.size(), tree_.nv());
  VectorXd forces = VectorXd::Zero(nv());
  for (int i = 0; i < tree_.nv(); ++i) {
    const CoupledVelocity& coupling = couplings_[i];
    if (coupling.independent >= 0) forces[coupling.independent] += coupling.factor * tree_forces[i];
  }
  return forces;
}

VectorXd MultibodyModel::Displaced(const Eigen::Ref<const VectorXd>& q,
                                   const Eigen::Ref<const VectorXd>& tangent) const {
  CheckSize("q", q.size(), nq());
  CheckSize("a tangent", tangent.size(), nv());
  VectorXd displaced = q;
  if (base_ == Base::kPlanar) {
    displaced += tangent;
    return displaced;
  }
  Eigen::Quaterniond orientation =
      models::Exponential(tangent.head<3>()) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  orientation.normalize();
  displaced.head<4>() << orientation.w(), orientation.x(), orientation.y(), orientation.z();
  displaced.tail(nq() - 4) += tangent.tail(nv() - 3);
  return displaced;
}

VectorXd MultibodyModel::ConfigurationRate(const Eigen::Ref<const VectorXd>& q,
                                           const Eigen::Ref<const VectorXd>& v) const {
  CheckSize("q", q.size(), nq());
  CheckSize("v", v.size(), nv());
  if (base_ == Base::kPlanar) return v;
  VectorXd rate(nq());
  const Eigen::Quaterniond spin(0, v[0] / 2, v[1] / 2, v[2] / 2);
  const Eigen::Quaterniond turned = spin * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  rate << turned.w(), turned.x(), turned.y(), turned.z(), v.tail(nv() - 3);
  return rate;
}

}  // namespace possibility::dynamics
