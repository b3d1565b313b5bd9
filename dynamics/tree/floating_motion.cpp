#include "dynamics/tree/floating_motion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/tree/base_joints.h"

namespace possibility::dynamics {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr int kYaw = 3;  // indices into q, v, a
constexpr int kRoll = 4;
constexpr int kPitch = 5;

void RequireJoints(const MultibodyModel& model, const char* caller) {
  if (model.base() == Base::kJoints) return;
  throw std::invalid_argument(std::string(caller) + ": the model's root is not on joints");
}

}  // namespace

FloatingMotion ToFloating(const MultibodyModel& model, const Eigen::Ref<const VectorXd>& q,
                          const Eigen::Ref<const VectorXd>& v,
                          const Eigen::Ref<const VectorXd>& a) {
  RequireJoints(model, "ToFloating");
  const VectorXd tree_q = model.TreeConfiguration(q);
  const VectorXd tree_v = model.TreeVelocity(v);
  const VectorXd tree_a = model.TreeVelocity(a);

  const Eigen::AngleAxisd yaw(q[kYaw], Vector3d::UnitZ());
  const Eigen::AngleAxisd roll(q[kRoll], Vector3d::UnitX());
  const Eigen::AngleAxisd pitch(q[kPitch], Vector3d::UnitY());
  const Eigen::Quaterniond R = yaw * roll * pitch;
  const Vector3d roll_axis = yaw * Vector3d::UnitX();
  const Vector3d pitch_axis = yaw * (roll * Vector3d::UnitY());
  const auto sum = [&](const VectorXd& rates) -> Vector3d {
    return rates[kYaw] * Vector3d::UnitZ() + rates[kRoll] * roll_axis + rates[kPitch] * pitch_axis;
  };
  // The axes turn with the joints that carry them.
  const Vector3d with_yaw = v[kYaw] * Vector3d::UnitZ();
  const Vector3d with_roll = with_yaw + v[kRoll] * roll_axis;
  const Vector3d turning_axes =
      v[kRoll] * with_yaw.cross(roll_axis) + v[kPitch] * with_roll.cross(pitch_axis);

  const int joints = model.tree().num_joints() - kNumBaseJoints;
  FloatingMotion motion;
  motion.q.resize(7 + joints);
  motion.q << R.w(), R.x(), R.y(), R.z(), q.head<3>(), tree_q.tail(joints);
  motion.v.resize(6 + joints);
  motion.v << sum(v), v.head<3>(), tree_v.tail(joints);
  motion.a.resize(6 + joints);
  motion.a << sum(a) + turning_axes, a.head<3>(), tree_a.tail(joints);
  return motion;
}

VectorXd FromFloating(const MultibodyModel& model, const Eigen::Ref<const VectorXd>& q) {
  RequireJoints(model, "FromFloating");
  const int joints = model.tree().num_joints() - kNumBaseJoints;
  if (q.size() != 7 + joints) {
    throw std::invalid_argument(
        fmt::format("FromFloating: q has {} entries, expected {}", q.size(), 7 + joints));
  }
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().matrix();
  VectorXd result(model.nv());
  result.head<3>() = q.segment<3>(4);
  // R = Rz(yaw) Rx(roll) Ry(pitch).
  result[kYaw] = std::atan2(-R(0, 1), R(1, 1));
  result[kRoll] = std::asin(std::clamp(R(2, 1), -1.0, 1.0));
  result[kPitch] = std::atan2(-R(2, 0), R(2, 2));
  for (int i = 0; i < model.num_joints(); ++i) {
    result[kNumBaseJoints + i] = q[7 + model.joints()[i] - kNumBaseJoints];
  }
  return result;
}

}  // namespace possibility::dynamics
