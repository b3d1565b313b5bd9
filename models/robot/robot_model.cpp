#include "models/robot/robot_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::models {
namespace {

template <typename Named>
int IndexOf(const std::vector<Named>& items, const std::string& name, const std::string& kind,
            const RobotModel& robot) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
    known.push_back(items[i].name);
  }
  throw InputError(fmt::format("{}: unknown {} '{}'{}", robot.file.string(), kind, name,
                               DidYouMean(name, known)));
}

}  // namespace

Eigen::Vector3d ContactPatch::Centre() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

Eigen::Isometry3d ContactPatch::Frame() const {
  constexpr double kAlongX = 0.9;  // cosine
  const bool is_along_x = std::abs(normal_L.x()) > kAlongX;
  const Eigen::Vector3d forward = is_along_x ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  Eigen::Isometry3d X_LP = Eigen::Isometry3d::Identity();
  X_LP.translation() = Centre();
  const Eigen::Vector3d y = -normal_L.cross(forward).normalized();
  X_LP.linear() << -y.cross(normal_L), y, -normal_L;
  return X_LP;
}

double RobotModel::TotalMass() const {
  double mass = 0;
  for (const Link& link : links) mass += link.inertial.mass;
  return mass;
}

bool RobotModel::IsCoupled(int joint) const {
  if (joints[joint].mimic) return true;
  return std::any_of(joints.begin(), joints.end(), [joint](const Joint& other) {
    return other.mimic && other.mimic->joint == joint;
  });
}

std::vector<int> RobotModel::LegJoints() const {
  std::set<int> legs;
  if (gaits.empty()) return {};
  for (const GaitLimb& limb : gaits.front().limbs) {
    for (const int joint : limb.joints) {
      if (!joints[joint].mimic) legs.insert(joint);
    }
  }
  return {legs.begin(), legs.end()};
}

int RobotModel::LinkIndex(const std::string& link) const {
  return IndexOf(links, link, "link", *this);
}

int RobotModel::JointIndex(const std::string& joint) const {
  return IndexOf(joints, joint, "joint", *this);
}

int RobotModel::ContactIndex(const std::string& contact) const {
  return IndexOf(contacts, contact, "contact", *this);
}

const Gait& RobotModel::GaitNamed(const std::string& gait) const {
  return gaits[IndexOf(gaits, gait, "gait", *this)];
}

Eigen::VectorXd RobotModel::Configuration(const Posture& posture, double x, double y, double yaw,
                                          double z) const {
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(posture.root_pitch, Eigen::Vector3d::UnitY()));
  Eigen::VectorXd q(nq());
  q << rotation.w(), rotation.x(), rotation.y(), rotation.z(), x, y, z + posture.root_height,
      posture.joints;
  return q;
}

}  // namespace possibility::models
