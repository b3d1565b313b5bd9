#include "actions/sagittal/folded_motion.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/sagittal/sagittal_lumping.h"

namespace possibility::actions {
namespace {

using dynamics::SagittalJoint;
using dynamics::SagittalReduction;
using Eigen::VectorXd;

/// Departure from a symmetric configuration in the plane, rad and m. Published masses of two sides
/// differ, and a flight is corrected for that by 0.02 rad.
constexpr double kSymmetric = 0.05;

/// Maps quantities of the robot to those of the folded one.
class Fold {
 public:
  explicit Fold(const SagittalReduction& reduction)
      : reduction_(reduction), pairs_(reduction.joints()) {}

  bool IsNearlySymmetric(const VectorXd& q) const {
    const double aside = std::max({std::abs(q[1]), std::abs(q[3]), std::abs(q[5])});
    const VectorXd means = Means(q.tail(reduction_.full().num_joints()));
    VectorXd planar = VectorXd::Zero(reduction_.model()->nq());
    for (int j = 0; j < reduction_.model()->num_joints(); ++j) {
      planar[3 + j] = means[reduction_.model()->joints()[j]];
    }
    const VectorXd off = q - reduction_.ExpandConfiguration(planar);
    return std::max(aside, off.tail(q.size() - 7).lpNorm<Eigen::Infinity>()) <= kSymmetric;
  }

  VectorXd Configuration(const VectorXd& q) const {
    const double half_pitch = std::atan2(q[2], q[0]);
    VectorXd folded(7 + pairs_.size());
    folded << std::cos(half_pitch), 0, std::sin(half_pitch), 0, q[4], 0, q[6],
        Means(q.tail(q.size() - 7));
    return folded;
  }
  /// Of velocities and accelerations.
  VectorXd Rate(const VectorXd& v) const {
    VectorXd folded(6 + pairs_.size());
    folded << 0, v[1], 0, v[3], 0, v[5], Means(v.tail(v.size() - 6));
    return folded;
  }
  VectorXd Torques(const VectorXd& full) const {
    return Combined([&](const SagittalJoint& pair) {
      return full[pair.left] + (pair.right < 0 ? 0 : pair.right_sign * full[pair.right]);
    });
  }
  VectorXd Stiffness(const VectorXd& full) const {
    return Combined([&](const SagittalJoint& pair) {
      return full[pair.left] + (pair.right < 0 ? 0 : full[pair.right]);
    });
  }

 private:
  VectorXd Means(const VectorXd& full) const {
    return Combined([&](const SagittalJoint& pair) {
      if (pair.right < 0) return full[pair.left];
      return (full[pair.left] + pair.right_sign * full[pair.right]) / 2;
    });
  }
  /// By joint of the folded robot.
  template <typename OfPair>
  VectorXd Combined(const OfPair& of_pair) const {
    VectorXd folded(pairs_.size());
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      folded[static_cast<Eigen::Index>(i)] = of_pair(pairs_[i]);
    }
    return folded;
  }

  const SagittalReduction& reduction_;
  const std::vector<SagittalJoint>& pairs_;
};

models::RobotModel FoldedRobot(const SagittalReduction& reduction) {
  models::RobotModel robot = reduction.model()->tree();
  robot.contacts = reduction.full().contacts;
  for (models::ContactPatch& patch : robot.contacts) {
    const Eigen::Isometry3d& X_GL = reduction.X_GL()[static_cast<std::size_t>(patch.link)];
    patch.link = reduction.lumped_link()[static_cast<std::size_t>(patch.link)];
    for (Eigen::Vector3d& point : patch.points) point = X_GL * point;
    patch.normal_L = X_GL.linear() * patch.normal_L;
  }
  return robot;
}

}  // namespace

std::optional<FoldedMotion> FoldMotion(const SagittalReduction& reduction, const Segment& motion,
                                       const RolloutGains& gains) {
  const Fold fold(reduction);
  FoldedMotion folded{FoldedRobot(reduction), motion, gains};
  for (Phase& phase : folded.motion.phases) {
    for (Knot& knot : phase.knots) {
      if (!fold.IsNearlySymmetric(knot.q)) return std::nullopt;
      knot.q = fold.Configuration(knot.q);
      knot.v = fold.Rate(knot.v);
      knot.a = fold.Rate(knot.a);
      knot.tau = fold.Torques(knot.tau);
    }
  }
  folded.gains.stiffness = fold.Stiffness(JointStiffness(reduction.full(), gains));
  return folded;
}

}  // namespace possibility::actions
