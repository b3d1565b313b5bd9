#include "actions/rollout/step_feedback.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "actions/plan/contact_name.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// When the robot looks at its tilt, as shares of a swing. Earlier it still rocks from the last
/// landing.
constexpr double kLooks[] = {0.55, 0.7, 0.85};
/// A limb that is off the ground for longer does not take a step, s.
constexpr double kLongestSwing = 1.5;
/// Greatest displacements of a foot, m and rad, and distance between feet that is kept, m.
constexpr double kFarthest = 0.2;
constexpr double kMostTurned = 0.4;
constexpr double kApart = 0.02;
/// Share of the capture point's error that a step covers, and of a pendulum's growth rate until the
/// landing: the foot that tips and comes down again brakes the robot as well. With shares of 0.35
/// to 0.5, 14 pushes of 10 N s against two plans left the robot standing; 0.65 and 1 overshoot.
constexpr double kShare = 0.4;
constexpr double kGrowth = 0.6;
/// Smaller errors, m, and tilts, rad, are those of walking itself.
constexpr double kSmallError = 0.02;
constexpr double kSmallTilt = 0.01;
/// Damping of the least-squares solution near stretched legs, m.
constexpr double kDamping = 0.02;

/// The two limbs that walk, of any gait of the robot; none if others bear as well.
std::vector<const models::GaitLimb*> WalkingLimbs(const models::RobotModel& robot,
                                                  const Segment& segment) {
  std::set<int> bearing;
  for (const Phase& phase : segment.phases) {
    if (phase.contacts.empty()) return {};
    for (const BearingPatch& patch : BearingPatches(robot, phase)) bearing.insert(patch.patch);
  }
  for (const models::Gait& gait : robot.gaits) {
    std::vector<const models::GaitLimb*> limbs;
    for (const models::GaitLimb& limb : gait.limbs) {
      if (limb.hold_orientation && bearing.contains(limb.contact)) limbs.push_back(&limb);
    }
    if (gait.limbs.size() == 2 && limbs.size() == 2 && bearing.size() == 2) return limbs;
  }
  return {};
}

bool Bears(const models::RobotModel& robot, const Phase& phase, int contact) {
  for (const BearingPatch& patch : BearingPatches(robot, phase)) {
    if (patch.patch == contact) return true;
  }
  return false;
}

double Width(const models::ContactPatch& patch) {
  double least = 0, most = 0;
  for (const Vector3d& p : patch.points) {
    const double y = (p - patch.Centre()).y();
    least = std::min(least, y);
    most = std::max(most, y);
  }
  return most - least;
}

/// The part of x beyond a length.
Vector3d Beyond(const Vector3d& x, double length) {
  return x.norm() > length ? Vector3d((1 - length / x.norm()) * x) : Vector3d::Zero();
}

Vector3d Limited(const Vector3d& x, double most) {
  return x.norm() > most ? Vector3d(most / x.norm() * x) : x;
}

}  // namespace

StepFeedback::Vector6d StepFeedback::Foot::At(double t) const {
  if (t >= land) return std::exp(-rate * (t - land)) * to;
  const double s = std::clamp((t - begin) / (land - begin), 0.0, 1.0);
  return from + s * s * (3 - 2 * s) * (to - from);
}

StepFeedback::StepFeedback(const Segment& segment, const models::RobotModel& robot)
    : robot_(&robot), kinematics_(robot) {
  for (const models::GaitLimb* limb : WalkingLimbs(robot, segment)) {
    Foot foot;
    foot.limb = limb;
    const int index = static_cast<int>(feet_.size());
    double lift = -1;  // s; negative while the foot bears
    for (const Phase& phase : segment.phases) {
      const double t = phase.knots.front().t;
      if (!Bears(robot, phase, limb->contact)) {
        if (lift < 0) lift = t;
      } else if (lift >= 0) {
        if (t - lift < kLongestSwing) swings_.push_back({index, lift, t});
        lift = -1;
      }
    }
    feet_.push_back(foot);
  }
  std::sort(swings_.begin(), swings_.end(),
            [](const Swing& a, const Swing& b) { return a.lift < b.lift; });
  for (const Swing& swing : swings_) {
    for (const double share : kLooks) {
      ticks_.push_back(swing.lift + share * (swing.land - swing.lift));
    }
  }
  std::sort(ticks_.begin(), ticks_.end());
}

const StepFeedback::Swing& StepFeedback::SwingAt(double t) const {
  const auto after = std::upper_bound(swings_.begin(), swings_.end(), t,
                                      [](double time, const Swing& s) { return time < s.lift; });
  return *(after - 1);
}

double StepFeedback::LandingAfter(double t) const { return SwingAt(t).land; }

Vector3d StepFeedback::PlaceOf(int foot) const {
  const models::ContactPatch& patch = robot_->contacts[feet_[foot].limb->contact];
  return kinematics_.Position(patch.link, patch.Centre());
}

void StepFeedback::Sense(double t, const RootTilt& root, const VectorXd& q_landing,
                         const Vector3d& normal) {
  const Swing& swing = SwingAt(t);
  kinematics_.SetPosition(q_landing);
  const Vector3d from_root = PlaceOf(swing.foot) - q_landing.segment<3>(4);
  const double height = -normal.dot(from_root);
  const double omega = std::sqrt(dynamics::kGravity / height);
  const double left = swing.land - t;
  const auto horizontal = [&](const Vector3d& x) { return Vector3d(x - normal.dot(x) * normal); };
  const Vector3d rate = horizontal(root.rate);
  const Vector3d tilt =
      Beyond(Limited(horizontal(root.tilt) + left * rate, kMostTurned), kSmallTilt);
  const Vector3d root_error = tilt.cross(height * normal);
  const Vector3d capture_error = std::exp(kGrowth * omega * left) *
                                 (horizontal(root.tilt) + rate / omega).cross(height * normal);
  Vector3d step = Limited(kShare * Beyond(capture_error, kSmallError), kFarthest);
  // The feet stay apart, seen along the line between them.
  const Vector3d apart = horizontal(PlaceOf(swing.foot) - PlaceOf(1 - swing.foot));
  const Vector3d side = horizontal(kinematics_.X_WL()[0].linear().col(1) *
                                   (apart.dot(kinematics_.X_WL()[0].linear().col(1)) > 0 ? 1 : -1))
                            .normalized();
  const models::ContactPatch& patch = robot_->contacts[feet_[swing.foot].limb->contact];
  const double room = std::max(0.0, apart.dot(side) - Width(patch) - kApart);
  const double inward = -step.dot(side);
  if (inward > room) step += (inward - room) * side;
  Foot& foot = feet_[swing.foot];
  foot.from = foot.At(t);
  foot.to << -tilt, Limited(step - root_error - tilt.cross(from_root), kFarthest);
  foot.begin = t;
  foot.land = swing.land;
  foot.rate = omega;
}

bool StepFeedback::IsCorrecting() const {
  return std::any_of(feet_.begin(), feet_.end(), [](const Foot& foot) { return foot.IsMoved(); });
}

std::optional<JointCorrection> StepFeedback::CorrectionAt(double t, const VectorXd& q) const {
  if (!IsCorrecting()) return std::nullopt;
  constexpr double kStep = 1e-4;  // s, of a central difference
  JointCorrection correction{VectorXd::Zero(robot_->num_joints()),
                             VectorXd::Zero(robot_->num_joints())};
  kinematics_.SetPosition(q);
  for (const Foot& foot : feet_) {
    if (!foot.IsMoved()) continue;
    const models::ContactPatch& patch = robot_->contacts[foot.limb->contact];
    kinematics_.FrameJacobian(patch.link, patch.Centre(), &jacobian_);
    const auto n = static_cast<Eigen::Index>(foot.limb->joints.size());
    Eigen::MatrixXd J(6, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      J.col(i) = jacobian_.col(6 + foot.limb->joints[static_cast<std::size_t>(i)]);
    }
    Eigen::MatrixXd gram = J.transpose() * J;
    gram.diagonal().array() += kDamping * kDamping;
    const Eigen::LLT<Eigen::MatrixXd> factor(gram);
    const VectorXd position = factor.solve(J.transpose() * foot.At(t));
    const VectorXd velocity =
        factor.solve(J.transpose() * (foot.At(t + kStep) - foot.At(t - kStep)) / (2 * kStep));
    for (Eigen::Index i = 0; i < n; ++i) {
      const int joint = foot.limb->joints[static_cast<std::size_t>(i)];
      correction.position[joint] = position[i];
      correction.velocity[joint] = velocity[i];
    }
  }
  return correction;
}

}  // namespace possibility::actions
