#include "actions/onboarding/foot_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "actions/wholebody/limb_bend.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/facts/zero_poses.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr int kStarts = 24;
constexpr int kIterations = 120;
constexpr double kDamping = 1e-4;
constexpr double kReached = 1e-9;
constexpr double kWidestStart = 1.2;  // rad

/// q with the root at the origin.
VectorXd AtOrigin(const VectorXd& joints) {
  VectorXd q(7 + joints.size());
  q << 1, 0, 0, 0, 0, 0, 0, joints;
  return q;
}

}  // namespace

FootPlacement::FootPlacement(const RobotDraft& draft, int side)
    : draft_(&draft),
      leg_(side == 0 ? &draft.left_leg : &draft.right_leg),
      patch_(&draft.robot.contacts[side]) {
  const int num_joints = draft.robot.num_joints();
  R_RL_ = models::PosesInRoot(draft.robot, VectorXd::Zero(num_joints))[patch_->link].linear();
  R_RL_ = models::SmallestRotation(R_RL_ * patch_->normal_L, -Eigen::Vector3d::UnitZ()) * R_RL_;
  const auto bend = BendOf(draft.robot, {side, true, *leg_});
  if (bend) knee_ = static_cast<int>(bend->joint);
}

std::optional<VectorXd> FootPlacement::SolveFrom(const Eigen::Vector3d& centre, double margin,
                                                 const VectorXd& joints,
                                                 const VectorXd& start) const {
  const models::RobotModel& robot = draft_->robot;
  dynamics::TreeKinematics kinematics(robot);
  VectorXd all = joints;
  VectorXd leg = start;
  const int count = static_cast<int>(leg_->size());
  Eigen::MatrixXd J(6, robot.nv()), reduced(6, count);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (int i = 0; i < count; ++i) {
      const models::Joint& joint = robot.joints[(*leg_)[i]];
      leg[i] = std::clamp(leg[i], joint.lower + margin, joint.upper - margin);
      all[(*leg_)[i]] = leg[i];
    }
    kinematics.SetPosition(AtOrigin(all));
    Eigen::Matrix<double, 6, 1> error;
    error << models::RotationVector(R_RL_ * kinematics.X_WL()[patch_->link].linear().transpose()),
        centre - kinematics.Position(patch_->link, patch_->Centre());
    if (error.norm() < kReached) return leg;
    kinematics.FrameJacobian(patch_->link, patch_->Centre(), &J);
    for (int i = 0; i < count; ++i) reduced.col(i) = J.col(6 + (*leg_)[i]);
    const double damping = kDamping * std::min(1.0, error.squaredNorm());
    const Eigen::Matrix<double, 6, 6> normal =
        reduced * reduced.transpose() + damping * Eigen::Matrix<double, 6, 6>::Identity();
    VectorXd step = reduced.transpose() * normal.ldlt().solve(error);
    constexpr double kLongest = 0.3;
    if (const double largest = step.lpNorm<Eigen::Infinity>(); largest > kLongest) {
      step *= kLongest / largest;
    }
    leg += step;
  }
  return std::nullopt;
}

double FootPlacement::Forwardness(const VectorXd& leg, const VectorXd& joints) const {
  if (knee_ < 1) return 0;
  VectorXd all = joints;
  for (std::size_t i = 0; i < leg_->size(); ++i) all[(*leg_)[i]] = leg[static_cast<int>(i)];
  const std::vector<Eigen::Isometry3d> X_RL = models::PosesInRoot(draft_->robot, all);
  const auto place = [&](int i) { return X_RL[(*leg_)[i] + 1].translation(); };
  const Eigen::Vector3d middle = 0.5 * (place(knee_ - 1) + place(knee_ + 1));
  return place(knee_).x() - middle.x();
}

std::optional<VectorXd> FootPlacement::Solve(const Eigen::Vector3d& centre, double margin,
                                             const VectorXd& joints) const {
  std::mt19937 random(1);
  std::optional<VectorXd> best;
  double least = std::numeric_limits<double>::infinity();
  for (int trial = 0; trial < kStarts; ++trial) {
    VectorXd start(leg_->size());
    for (int i = 0; i < start.size(); ++i) {
      const models::Joint& joint = draft_->robot.joints[(*leg_)[i]];
      const double low = std::max(joint.lower, -kWidestStart);
      const double high = std::min(joint.upper, kWidestStart);
      start[i] = std::uniform_real_distribution<double>(std::min(low, high), high)(random);
    }
    const std::optional<VectorXd> leg = SolveFrom(centre, margin, joints, start);
    if (!leg) continue;
    constexpr double kBackward = 100;  // rad^2
    const double cost = leg->squaredNorm() + (Forwardness(*leg, joints) < 0 ? kBackward : 0);
    if (cost < least) {
      least = cost;
      best = leg;
    }
  }
  return best;
}

std::string FootPlacement::WhyNot(const Eigen::Vector3d& centre, double margin,
                                  const VectorXd& joints) const {
  constexpr double kWide = 10;  // rad: as if there were no limits
  const std::optional<VectorXd> leg = Solve(centre, -kWide, joints);
  if (!leg) return "out of reach";
  double most = 0;
  std::string reason = "out of reach but for some limits";
  for (int i = 0; i < leg->size(); ++i) {
    const models::Joint& joint = draft_->robot.joints[(*leg_)[i]];
    const double value = (*leg)[i];
    const double beyond = std::max(joint.lower + margin - value, value - joint.upper + margin);
    if (!(beyond > most)) continue;
    most = beyond;
    reason = fmt::format("'{}' would be at {:.2f}, its limits are {:.2f} to {:.2f}", joint.name,
                         value, joint.lower, joint.upper);
  }
  return reason;
}

}  // namespace possibility::actions
