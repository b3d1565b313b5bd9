#include "dynamics/tree/multibody_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/tree/base_joints.h"
#include "models/robot/rotation_vector.h"

namespace possibility::dynamics {

namespace {

using Eigen::VectorXd;

constexpr int kPitchRate = 1;  // index into a tree's velocity: angular about +y
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
  return std::shared_ptr<const MultibodyModel>(new MultibodyModel(robot, Base::kFloating, {}));
}

std::shared_ptr<const MultibodyModel> MultibodyModel::Planar(const models::RobotModel& tree) {
  CheckPlanar(tree);
  return std::shared_ptr<const MultibodyModel>(new MultibodyModel(tree, Base::kPlanar, {}));
}

std::shared_ptr<const MultibodyModel> MultibodyModel::OnJoints(
    const models::RobotModel& robot, const std::map<int, double>& locked) {
  std::map<int, double> locked_in_tree;
  for (const auto& [joint, position] : locked) {
    if (joint < 0 || joint >= robot.num_joints()) {
      throw std::invalid_argument(fmt::format(
          "MultibodyModel: joint {} is locked, expected 0 to {}", joint, robot.num_joints() - 1));
    }
    const std::string& name = robot.joints[joint].name;
    if (robot.joints[joint].mimic) {
      throw std::invalid_argument(
          fmt::format("MultibodyModel: joint '{}' is locked but mimics another one", name));
    }
    if (!std::isfinite(position)) {
      throw std::invalid_argument(
          fmt::format("MultibodyModel: joint '{}' is locked at {}", name, position));
    }
    locked_in_tree[kNumBaseJoints + joint] = position;
  }
  return std::shared_ptr<const MultibodyModel>(
      new MultibodyModel(OnBaseJoints(robot), Base::kJoints, locked_in_tree));
}

MultibodyModel::MultibodyModel(models::RobotModel tree, Base base,
                               const std::map<int, double>& locked)
    : tree_(std::move(tree)), base_(base) {
  CoupleBase();
  CoupleJoints(locked);
  CombineLimits();
  FindMovedLinks();
}

void MultibodyModel::CoupleBase() {
  couplings_.resize(tree_.nv());
  switch (base_) {
    case Base::kFloating:
      for (int i = 0; i < 6; ++i) couplings_[i].independent = i;
      translations_ = {{3, Eigen::Vector3d::UnitX()},
                       {4, Eigen::Vector3d::UnitY()},
                       {5, Eigen::Vector3d::UnitZ()}};
      break;
    case Base::kPlanar:
      couplings_[kPitchRate].independent = 0;
      couplings_[kX].independent = 1;
      couplings_[kZ].independent = 2;
      translations_ = {{1, Eigen::Vector3d::UnitX()}, {2, Eigen::Vector3d::UnitZ()}};
      break;
    case Base::kJoints:
      for (int i = 0; i < kNumBaseJoints; ++i) couplings_[6 + i].independent = i;
      translations_ = {{0, Eigen::Vector3d::UnitX()},
                       {1, Eigen::Vector3d::UnitY()},
                       {2, Eigen::Vector3d::UnitZ()}};
      break;
  }
}

void MultibodyModel::CoupleJoints(const std::map<int, double>& locked) {
  const int first = base_ == Base::kJoints ? kNumBaseJoints : 0;
  std::vector<int> independent(tree_.num_joints(), -1);
  for (int j = first; j < tree_.num_joints(); ++j) {
    if (tree_.joints[j].mimic || locked.contains(j)) continue;
    independent[j] = num_base_velocities() + static_cast<int>(joints_.size());
    joints_.push_back(j);
  }
  offsets_ = VectorXd::Zero(tree_.num_joints());
  for (int j = first; j < tree_.num_joints(); ++j) {
    const auto& mimic = tree_.joints[j].mimic;
    const int master = mimic ? mimic->joint : j;
    const bool exists = master >= first && master < tree_.num_joints();
    if (!exists || (independent[master] < 0 && !locked.contains(master))) {
      throw std::invalid_argument(fmt::format(
          "MultibodyModel: joint '{}' mimics no independent joint", tree_.joints[j].name));
    }
    const double factor = mimic ? mimic->multiplier : 1.0;
    couplings_[6 + j] = {independent[master], factor};
    if (mimic) offsets_[j] = mimic->offset;
    if (independent[master] < 0) offsets_[j] += factor * locked.at(master);
  }
  is_identity_ = base_ == Base::kFloating && num_joints() == tree_.num_joints();
}

void MultibodyModel::FindMovedLinks() {
  carried_by_.assign(tree_.num_links(), std::vector<bool>(tree_.num_joints(), false));
  for (int link = 1; link < tree_.num_links(); ++link) {
    carried_by_[link] = carried_by_[tree_.joints[link - 1].parent];
    carried_by_[link][link - 1] = true;
  }
  sources_.resize(nv());
  for (int i = 0; i < tree_.nv(); ++i) {
    if (couplings_[i].independent >= 0) sources_[couplings_[i].independent].push_back(i);
  }
  moves_.assign(nv(), std::vector<bool>(tree_.num_links(), false));
  related_.assign(nv(), std::vector<bool>(nv(), false));
  for (int i = 0; i < nv(); ++i) {
    for (const int source : sources_[i]) {
      for (int link = 0; link < tree_.num_links(); ++link) {
        if (MovesInTree(source, link)) moves_[i][link] = true;
      }
    }
    for (int j = 0; j <= i; ++j) {
      for (int link = 0; link < tree_.num_links(); ++link) {
        if (moves_[i][link] && moves_[j][link]) related_[i][j] = related_[j][i] = true;
      }
    }
  }
}

bool MultibodyModel::MovesInTree(int tree_velocity, int link) const {
  return tree_velocity < 6 || carried_by_[link][tree_velocity - 6];
}

bool MultibodyModel::MovesApart(int velocity, int link, int other) const {
  return std::any_of(sources_.at(velocity).begin(), sources_.at(velocity).end(), [&](int source) {
    return MovesInTree(source, link) != MovesInTree(source, other);
  });
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
    has_lines_ = has_lines_ || joint.actuator.line;
  }
  for (int j = 0; j < tree_.num_joints(); ++j) {
    const models::Joint& joint = tree_.joints[j];
    if (!joint.mimic) continue;
    const int i = couplings_[6 + j].independent - num_base_velocities();
    if (i < 0) continue;  // its master is locked
    const double factor = joint.mimic->multiplier;
    const double a = (joint.lower - joint.mimic->offset) / factor;
    const double b = (joint.upper - joint.mimic->offset) / factor;
    lower_[i] = std::max(lower_[i], std::min(a, b));
    upper_[i] = std::min(upper_[i], std::max(a, b));
    velocity_[i] = std::min(velocity_[i], joint.velocity / std::abs(factor));
  }
}

VectorXd MultibodyModel::TorqueLimits(const Eigen::Ref<const VectorXd>& v) const {
  CheckSize("v", v.size(), nv());
  VectorXd limits = effort_;
  if (!has_lines_) return limits;
  for (int i = 0; i < num_joints(); ++i) {
    limits[i] = actuator(i).Limit(effort_[i], v[num_base_velocities() + i]);
  }
  return limits;
}

VectorXd MultibodyModel::TreeConfiguration(const Eigen::Ref<const VectorXd>& q) const {
  CheckSize("q", q.size(), nq());
  VectorXd tree(tree_.nq());
  if (base_ == Base::kFloating) {
    tree.head<7>() = q.head<7>();
  } else if (base_ == Base::kPlanar) {
    tree.head<7>() << std::cos(q[0] / 2), 0, std::sin(q[0] / 2), 0, q[1], 0, q[2];
  } else {
    tree.head<7>().setUnit(0);
  }
  const int shift = num_base_positions() - num_base_velocities();
  for (int j = 0; j < tree_.num_joints(); ++j) {
    const CoupledVelocity& coupling = couplings_[6 + j];
    const double moved =
        coupling.independent < 0 ? 0 : coupling.factor * q[coupling.independent + shift];
    tree[7 + j] = moved + offsets_[j];
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

void MultibodyModel::ReduceColumns(const Eigen::MatrixXd& tree,
                                   // A writable Eigen::Ref is passed by value.
                                   // NOLINTNEXTLINE(performance-unnecessary-value-param)
                                   Eigen::Ref<Eigen::MatrixXd> reduced) const {
  CheckSize("a derivative of the tree", tree.cols(), tree_.nv());
  CheckSize("a derivative", reduced.cols(), nv());
  reduced.setZero();
  for (int c = 0; c < tree_.nv(); ++c) {
    const CoupledVelocity& column = couplings_[c];
    if (column.independent >= 0) reduced.col(column.independent) += column.factor * tree.col(c);
  }
}

VectorXd MultibodyModel::Displaced(const Eigen::Ref<const VectorXd>& q,
                                   const Eigen::Ref<const VectorXd>& tangent) const {
  CheckSize("q", q.size(), nq());
  CheckSize("a tangent", tangent.size(), nv());
  VectorXd displaced = q;
  if (base_ != Base::kFloating) {
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
  if (base_ != Base::kFloating) return v;
  VectorXd rate(nq());
  const Eigen::Quaterniond spin(0, v[0] / 2, v[1] / 2, v[2] / 2);
  const Eigen::Quaterniond turned = spin * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  rate << turned.w(), turned.x(), turned.y(), turned.z(), v.tail(nv() - 3);
  return rate;
}

}  // namespace possibility::dynamics
