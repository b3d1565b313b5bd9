#include "dynamics/sagittal/sagittal_reduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace possibility::dynamics {

namespace {

using Eigen::VectorXd;

constexpr int kNumBase = 6;        // number of base entries in full velocities
constexpr int kNumPlanarBase = 3;  // number of base entries in planar velocities

void Check(const char* what, const Eigen::Ref<const VectorXd>& x, int expected) {
  if (x.size() != expected) {
    throw std::invalid_argument(fmt::format("SagittalReduction: {} has {} elements, expected {}",
                                            what, x.size(), expected));
  }
  if (!x.allFinite()) {
    throw std::invalid_argument(fmt::format("SagittalReduction: {} is not finite", what));
  }
}

VectorXd CheckedLocked(const models::RobotModel& robot, const std::optional<VectorXd>& locked) {
  if (!locked) return VectorXd::Zero(robot.num_joints());
  Check("locked", *locked, robot.num_joints());
  return *locked;
}

/// The left joint's share of the effort limits of both; only joints with a motor count.
double LeftShare(const models::RobotModel& robot, const SagittalJoint& pair) {
  const models::Joint& left = robot.joints[pair.left];
  if (pair.right < 0) return 1;
  const models::Joint& right = robot.joints[pair.right];
  if (left.mimic.has_value() != right.mimic.has_value()) return left.mimic ? 0 : 1;
  if (std::isinf(left.effort) || std::isinf(right.effort)) {
    return std::isinf(left.effort) == std::isinf(right.effort) ? 0.5
           : std::isinf(left.effort)                           ? 1
                                                               : 0;
  }
  const double sum = left.effort + right.effort;
  return sum > 0 ? left.effort / sum : 0.5;
}

/// @throws std::invalid_argument that names the entry with the largest deviation. `num_base`:
/// number of entries before the joints.
void CompareSymmetric(const models::RobotModel& robot, const char* what, const VectorXd& given,
                      const VectorXd& symmetric, int num_base, double tolerance) {
  if (!(tolerance >= 0)) {
    throw std::invalid_argument(fmt::format(
        "SagittalReduction: the tolerance is {}, expected a number of at least 0", tolerance));
  }
  Eigen::Index worst = 0;
  const double off = (given - symmetric).cwiseAbs().maxCoeff(&worst);
  if (off <= tolerance) return;
  const std::string entry = worst < num_base
                                ? fmt::format("entry {} (of the root)", worst)
                                : fmt::format("joint '{}'", robot.joints[worst - num_base].name);
  throw std::invalid_argument(
      fmt::format("SagittalReduction: {} is not symmetric: {} is {:.9g}, expected {:.9g}", what,
                  entry, given[worst], symmetric[worst]));
}

}  // namespace

SagittalReduction::SagittalReduction(const models::RobotModel& robot,
                                     const std::optional<VectorXd>& locked)
    : full_(robot), lumping_(LumpSagittally(full_, CheckedLocked(robot, locked))) {
  for (const SagittalJoint& pair : lumping_.joints) left_shares_.push_back(LeftShare(full_, pair));
  model_ = MultibodyModel::Planar(lumping_.tree);
}

VectorXd SagittalReduction::ExpandConfiguration(const Eigen::Ref<const VectorXd>& q) const {
  Check("q", q, model_->nq());
  const VectorXd tree = model_->TreeConfiguration(q);
  VectorXd full(full_.nq());
  full.head<7>() = tree.head<7>();
  full.tail(full_.num_joints()) = lumping_.rest;
  for (std::size_t i = 0; i < lumping_.joints.size(); ++i) {
    const SagittalJoint& pair = lumping_.joints[i];
    full[7 + pair.left] = tree[7 + i];
    if (pair.right >= 0) full[7 + pair.right] = pair.right_sign * tree[7 + i];
  }
  return full;
}

VectorXd SagittalReduction::ExpandVelocity(const Eigen::Ref<const VectorXd>& v) const {
  Check("v", v, model_->nv());
  const VectorXd tree = model_->TreeVelocity(v);
  VectorXd full = VectorXd::Zero(full_.nv());
  full.head<kNumBase>() = tree.head<kNumBase>();
  for (std::size_t i = 0; i < lumping_.joints.size(); ++i) {
    const SagittalJoint& pair = lumping_.joints[i];
    full[kNumBase + pair.left] = tree[kNumBase + i];
    if (pair.right >= 0) full[kNumBase + pair.right] = pair.right_sign * tree[kNumBase + i];
  }
  return full;
}

VectorXd SagittalReduction::ReduceConfiguration(const Eigen::Ref<const VectorXd>& full_q,
                                                double tolerance) const {
  Check("the full q", full_q, full_.nq());
  VectorXd given = full_q;
  const double norm = given.head<4>().norm();
  if (!(norm > 1e-100 && std::isfinite(norm))) {
    throw std::invalid_argument(
        "SagittalReduction: the quaternion in the full q cannot be normalised");
  }
  given.head<4>() /= norm;
  VectorXd q(model_->nq());
  const double pitch = 2 * std::atan2(given[2], given[0]);
  q[0] = std::remainder(pitch, 2 * std::numbers::pi);
  q[1] = given[4];
  q[2] = given[6];
  for (int i = 0; i < model_->num_joints(); ++i) {
    q[kNumPlanarBase + i] = given[7 + lumping_.joints[model_->joints()[i]].left];
  }
  const VectorXd symmetric = ExpandConfiguration(q);
  // A quaternion and its negative are the same orientation.
  if (given.head<4>().dot(symmetric.head<4>()) < 0) given.head<4>() *= -1;
  CompareSymmetric(full_, "the full q", given, symmetric, 7, tolerance);
  return q;
}

VectorXd SagittalReduction::ReduceVelocity(const Eigen::Ref<const VectorXd>& full_v,
                                           double tolerance) const {
  Check("the full v", full_v, full_.nv());
  VectorXd v(model_->nv());
  v[0] = full_v[1];
  v[1] = full_v[3];
  v[2] = full_v[5];
  for (int i = 0; i < model_->num_joints(); ++i) {
    v[kNumPlanarBase + i] = full_v[kNumBase + lumping_.joints[model_->joints()[i]].left];
  }
  CompareSymmetric(full_, "the full v", full_v, ExpandVelocity(v), kNumBase, tolerance);
  return v;
}

VectorXd SagittalReduction::ReduceForces(const Eigen::Ref<const VectorXd>& full_forces) const {
  Check("full_forces", full_forces, full_.nv());
  VectorXd tree(lumping_.tree.nv());
  tree.head<kNumBase>() = full_forces.head<kNumBase>();
  for (std::size_t i = 0; i < lumping_.joints.size(); ++i) {
    const SagittalJoint& pair = lumping_.joints[i];
    tree[kNumBase + i] = full_forces[kNumBase + pair.left];
    if (pair.right >= 0) {
      tree[kNumBase + i] += pair.right_sign * full_forces[kNumBase + pair.right];
    }
  }
  return model_->IndependentForces(tree);
}

VectorXd SagittalReduction::ExpandForces(const Eigen::Ref<const VectorXd>& forces) const {
  Check("forces", forces, model_->nv());
  VectorXd full = VectorXd::Zero(full_.nv());
  full[1] = forces[0];
  full[3] = forces[1];
  full[5] = forces[2];
  for (int i = 0; i < model_->num_joints(); ++i) {
    const int joint = model_->joints()[i];
    const SagittalJoint& pair = lumping_.joints[joint];
    const double force = forces[kNumPlanarBase + i];
    full[kNumBase + pair.left] = left_shares_[joint] * force;
    if (pair.right >= 0) {
      full[kNumBase + pair.right] = pair.right_sign * (1 - left_shares_[joint]) * force;
    }
  }
  return full;
}

OutOfPlaneForces SagittalReduction::OutOfPlane(
    const Eigen::Ref<const VectorXd>& full_forces) const {
  Check("full_forces", full_forces, full_.nv());
  OutOfPlaneForces result{full_forces[4], full_forces[0], full_forces[2], 0};
  for (const auto* pairs : {&lumping_.joints, &lumping_.locked}) {
    for (const SagittalJoint& pair : *pairs) {
      if (pair.right < 0) continue;
      const double difference =
          full_forces[kNumBase + pair.left] - pair.right_sign * full_forces[kNumBase + pair.right];
      result.pair_difference = std::max(result.pair_difference, std::abs(difference));
    }
  }
  return result;
}

ContactPoint SagittalReduction::LumpedPoint(const ContactPoint& full_point) const {
  CheckContactPoints("SagittalReduction", full_.num_links(), {full_point});
  ContactPoint point = full_point;
  point.link = lumping_.lumped_link[full_point.link];
  point.p_L = lumping_.X_GL[full_point.link] * full_point.p_L;
  point.p_L.y() = 0;
  return point;
}

const std::vector<ContactPoint>& SagittalReduction::FullPoints(int contact, int point) const {
  return lumping_.full_points.at(contact).at(point);
}

Eigen::Matrix3Xd SagittalReduction::ExpandContactForce(int contact, int point,
                                                       const Eigen::Vector3d& force) const {
  Check("a contact force", force, 3);
  const auto count = static_cast<Eigen::Index>(FullPoints(contact, point).size());
  return (force / static_cast<double>(count)).replicate(1, count);
}

}  // namespace possibility::dynamics
