#include "dynamics/sagittal/mirror_image.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "dynamics/tree/base_joints.h"
#include "models/input/input_error.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// By joint of the robot: its axis in the root's frame with all joints at 0.
std::vector<Vector3d> AxesAtRest(const models::RobotModel& robot) {
  std::vector<Eigen::Matrix3d> R(robot.num_links(), Eigen::Matrix3d::Identity());
  std::vector<Vector3d> axes;
  for (int i = 0; i < robot.num_joints(); ++i) {
    const models::Joint& joint = robot.joints[i];
    R[i + 1] = R[joint.parent] * joint.X_PJ.linear();
    axes.push_back(R[i + 1] * joint.axis);
  }
  return axes;
}

/// Factor of the right joint's rate for the left joint's mirrored motion. A displacement is
/// mirrored; a mirrored rotation has the opposite sense about the mirrored axis.
std::optional<double> SignBetween(const models::Joint& left, const Vector3d& left_axis,
                                  const models::Joint& right, const Vector3d& right_axis) {
  constexpr double kTolerance = 1e-3;
  const bool slides = left.type == models::JointType::kPrismatic;
  if (slides != (right.type == models::JointType::kPrismatic)) return std::nullopt;
  const Vector3d image =
      (slides ? 1.0 : -1.0) * Vector3d(left_axis.x(), -left_axis.y(), left_axis.z());
  for (const double sign : {1.0, -1.0}) {
    if ((right_axis - sign * image).norm() <= kTolerance) return sign;
  }
  return std::nullopt;
}

[[noreturn]] void Fail(const models::RobotModel& robot, const std::string& what) {
  const std::string source = robot.file.empty() ? robot.name : robot.file.string();
  throw InputError(fmt::format("{}: mirror image: {}", source, what));
}

std::vector<int> Partners(const models::RobotModel& robot) {
  std::vector<int> partners(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) partners[i] = i;
  for (const auto& [left, right] : robot.sagittal_pairs) {
    partners.at(left) = right;
    partners.at(right) = left;
  }
  return partners;
}

}  // namespace

VectorXd MirrorImage::Of(const Eigen::Ref<const VectorXd>& x) const {
  VectorXd image(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) image[i] = sign[i] * x[source[i]];
  return image;
}

MirrorImage MirrorImageOf(const models::RobotModel& robot, const MultibodyModel& model) {
  if (model.base() != Base::kJoints) {
    throw std::invalid_argument("MirrorImageOf: the model's root is not on joints");
  }
  MirrorImage image{std::vector<int>(model.nv()), VectorXd::Ones(model.nv())};
  for (int i = 0; i < kNumBaseJoints; ++i) image.source[i] = i;
  image.sign.head<kNumBaseJoints>() << 1, -1, 1, -1, -1, 1;  // x, y, z, yaw, roll, pitch

  std::vector<int> coordinate(robot.num_joints(), -1);
  for (int i = 0; i < model.num_joints(); ++i) {
    coordinate[model.joints()[i] - kNumBaseJoints] = kNumBaseJoints + i;
  }
  const std::vector<int> partners = Partners(robot);
  const std::vector<Vector3d> axes = AxesAtRest(robot);
  for (int joint = 0; joint < robot.num_joints(); ++joint) {
    if (coordinate[joint] < 0) continue;
    const int partner = partners[joint];
    const std::string& name = robot.joints[joint].name;
    const std::string& other = robot.joints[partner].name;
    if (coordinate[partner] < 0) {
      Fail(robot, fmt::format("joint '{}' is free but '{}' is not", name, other));
    }
    const auto sign =
        SignBetween(robot.joints[partner], axes[partner], robot.joints[joint], axes[joint]);
    if (!sign)
      Fail(robot, fmt::format("joints '{}' and '{}' do not mirror each other", name, other));
    image.source[coordinate[joint]] = coordinate[partner];
    image.sign[coordinate[joint]] = *sign;
  }
  return image;
}

}  // namespace possibility::dynamics
