#include "models/facts/mirror_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "models/facts/zero_poses.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

class PairFinder {
 public:
  PairFinder(const RobotModel& robot, double tolerance)
      : robot_(robot),
        tolerance_(tolerance),
        X_RL_(PosesInRoot(robot, Eigen::VectorXd::Zero(robot.num_joints()))),
        partner_(robot.links.size(), -1) {
    partner_[0] = 0;
  }

  MirrorPairs Find() {
    for (int joint = 0; joint < robot_.num_joints(); ++joint) {
      if (partner_[joint + 1] >= 0) continue;
      const int other = BestPartner(joint);
      if (other < 0) {
        result_.unpaired.push_back(joint);
        continue;
      }
      partner_[joint + 1] = other + 1;
      partner_[other + 1] = joint + 1;
      Record(joint, other);
    }
    return std::move(result_);
  }

 private:
  Vector3d Place(int joint) const { return X_RL_[joint + 1].translation(); }
  Vector3d Axis(int joint) const { return X_RL_[joint + 1].linear() * robot_.joints[joint].axis; }

  Vector3d Offset(int joint, int other) const {
    return Place(other) - Place(joint).cwiseProduct(Vector3d(1, -1, 1));
  }

  /// Where along its axis a joint that turns has its origin is arbitrary.
  double Distance(int joint, int other) const {
    const Vector3d offset = Offset(joint, other);
    if (robot_.joints[joint].type == JointType::kPrismatic) return offset.norm();
    const Vector3d axis = Axis(other);
    return (offset - axis.dot(offset) * axis).norm();
  }

  /// 1 or -1 if the axes mirror each other. A turn about an axis mirrors to the opposite turn about
  /// the mirrored axis, a slide to one along the mirrored axis.
  std::optional<double> Sign(int joint, int other) const {
    const bool slides = robot_.joints[joint].type == JointType::kPrismatic;
    const Vector3d mirror = slides ? Vector3d(1, -1, 1) : Vector3d(-1, 1, -1);
    const double along = Axis(joint).cwiseProduct(mirror).dot(Axis(other));
    constexpr double kAligned = 0.995;  // cosine of 0.1 rad
    if (std::abs(along) < kAligned) return std::nullopt;
    return along > 0 ? 1 : -1;
  }

  int BestPartner(int joint) const {
    const int parent = partner_[robot_.joints[joint].parent];
    int best = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (int other = 0; other < robot_.num_joints(); ++other) {
      const bool is_free = partner_[other + 1] < 0 && robot_.joints[other].parent == parent &&
                           robot_.joints[other].type == robot_.joints[joint].type;
      if (!is_free || !Sign(joint, other) || !(Distance(joint, other) <= tolerance_)) continue;
      // A joint in the plane is its own partner. Of joints on one axis the nearest origin counts.
      const double distance = Offset(joint, other).norm();
      if (distance < nearest || (other == joint && distance <= nearest)) {
        nearest = distance;
        best = other;
      }
    }
    return best;
  }

  void Record(int joint, int other) {
    if (const double distance = Distance(joint, other); distance > result_.worst_distance) {
      result_.worst_distance = distance;
      result_.worst_link = robot_.links[joint + 1].name;
    }
    if (joint == other) return;
    const bool is_left = Place(joint).y() > Place(other).y();
    const int left = is_left ? joint : other, right = is_left ? other : joint;
    result_.pairs.push_back({left, right, *Sign(left, right)});
    const double mass =
        std::abs(robot_.links[left + 1].inertial.mass - robot_.links[right + 1].inertial.mass);
    if (mass > result_.worst_mass) {
      result_.worst_mass = mass;
      result_.worst_mass_link = robot_.links[left + 1].name;
    }
  }

  const RobotModel& robot_;
  const double tolerance_;
  const std::vector<Eigen::Isometry3d> X_RL_;
  std::vector<int> partner_;  ///< by link; -1: none yet
  MirrorPairs result_;
};

}  // namespace

Eigen::VectorXd MirrorPairs::Mirrored(const Eigen::VectorXd& joints) const {
  Eigen::VectorXd mirrored = joints;
  for (const auto& [left, right, sign] : pairs) {
    mirrored[left] = sign * joints[right];
    mirrored[right] = sign * joints[left];
  }
  return mirrored;
}

MirrorPairs FindMirrorPairs(const RobotModel& robot, double tolerance) {
  return PairFinder(robot, tolerance).Find();
}

}  // namespace possibility::models
