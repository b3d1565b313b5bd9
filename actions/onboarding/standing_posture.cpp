#include "actions/onboarding/standing_posture.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/onboarding/arm_posture.h"
#include "actions/onboarding/foot_placement.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/facts/zero_poses.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kJointMargin = 0.03;  // rad, from the limits of the legs
constexpr int kRounds = 12;
constexpr double kBalanced = 1e-5;  // m
constexpr double kLeastGap = 0.07;  // between the soles, of the leg's length
constexpr double kFromHeel = 0.3;   // of the sole's length: least distance of the balance point

class Stander {
 public:
  Stander(const RobotDraft& draft, const StandingChoice& choice)
      : draft_(draft), left_(draft, 0), right_(draft, 1), kinematics_(draft.robot) {
    const std::vector<Eigen::Isometry3d> X_RL =
        models::PosesInRoot(draft.robot, VectorXd::Zero(draft.robot.num_joints()));
    const auto sole = [&](int side) {
      const models::ContactPatch& patch = draft.robot.contacts[side];
      return Vector3d(X_RL[patch.link] * patch.Centre());
    };
    const double hips = X_RL[draft.left_leg.front() + 1].translation().z();
    middle_ = 0.5 * (sole(0) + sole(1));
    const double apart = choice.spread * (sole(0).y() - sole(1).y());
    half_ = 0.5 * std::max(apart, draft.sole_breadth + kLeastGap * draft.leg_length);
    middle_.z() = hips - choice.extension * draft.leg_length;
    joints_ = Rest();
    balanced_ = BalancePoint(X_RL);
  }

  /// False, with a reason, if the legs do not reach.
  bool Stand(std::string* reason) {
    for (int round = 0; round < kRounds; ++round) {
      if (!PlaceFeet(round == 0, reason)) return false;
      if (round == 0 && !draft_.rest) joints_ = PostureWithArms(draft_, joints_);
      VectorXd q(7 + joints_.size());
      q << 1, 0, 0, 0, 0, 0, 0, joints_;
      kinematics_.SetPosition(q);
      const Vector3d com = kinematics_.CentreOfMass();
      const double ahead = com.x() - balanced_ - middle_.x();
      if (std::abs(ahead) < kBalanced) break;
      middle_.x() += ahead;
    }
    return true;
  }

  const VectorXd& joints() const { return joints_; }
  double root_height() const { return -middle_.z(); }
  double sole_distance() const { return 2 * half_; }

 private:
  /// The joints that are given, otherwise 0, or as near as their limits allow.
  VectorXd Rest() const {
    if (draft_.rest) return *draft_.rest;
    VectorXd rest(draft_.robot.num_joints());
    for (int i = 0; i < rest.size(); ++i) {
      const models::Joint& joint = draft_.robot.joints[i];
      rest[i] = std::clamp(0.0, joint.lower, joint.upper);
    }
    return rest;
  }

  /// Where the centre of mass is held, ahead of the soles' centre, m: above the ankles, which then
  /// bear least, but not too near the heels.
  double BalancePoint(const std::vector<Eigen::Isometry3d>& X_RL) const {
    const models::ContactPatch& patch = draft_.robot.contacts[0];
    const Eigen::Isometry3d& X_RF = X_RL[patch.link];
    const double centre = (X_RF * patch.Centre()).x();
    double heel = 0, toe = 0;
    for (const Vector3d& p : patch.points) {
      heel = std::min(heel, (X_RF * p).x() - centre);
      toe = std::max(toe, (X_RF * p).x() - centre);
    }
    const double ankle = X_RF.translation().x() - centre;
    const double inside = kFromHeel * (toe - heel);
    return std::clamp(ankle, heel + inside, toe - inside);
  }

  bool PlaceFeet(bool is_first, std::string* reason) {
    for (const int side : {0, 1}) {
      const FootPlacement& foot = side == 0 ? left_ : right_;
      const std::vector<int>& leg = side == 0 ? draft_.left_leg : draft_.right_leg;
      const Vector3d centre = middle_ + Vector3d(0, side == 0 ? half_ : -half_, 0);
      VectorXd start(leg.size());
      for (std::size_t i = 0; i < leg.size(); ++i) start[static_cast<int>(i)] = joints_[leg[i]];
      // The right leg begins as the left one's image.
      if (is_first && side == 1) {
        const VectorXd mirrored = draft_.pairs.Mirrored(joints_);
        for (std::size_t i = 0; i < leg.size(); ++i) start[static_cast<int>(i)] = mirrored[leg[i]];
      }
      std::optional<VectorXd> solved;
      if (!is_first || side == 1) solved = foot.SolveFrom(centre, kJointMargin, joints_, start);
      if (!solved) solved = foot.Solve(centre, kJointMargin, joints_);
      if (!solved) {
        *reason = fmt::format("the {} leg cannot put its sole level {:.3f} m below the root: {}",
                              side == 0 ? "left" : "right", -centre.z(),
                              foot.WhyNot(centre, kJointMargin, joints_));
        return false;
      }
      for (std::size_t i = 0; i < leg.size(); ++i) joints_[leg[i]] = (*solved)[static_cast<int>(i)];
    }
    return true;
  }

  const RobotDraft& draft_;
  const FootPlacement left_, right_;
  dynamics::TreeKinematics kinematics_;
  Vector3d middle_;      ///< between the soles' centres, in the root's frame
  double balanced_ = 0;  ///< m: see BalancePoint
  double half_ = 0;      ///< m, from the middle to a sole
  VectorXd joints_;
};

/// Torques with all the weight on the left sole, as if the centre of mass were above it: what a
/// lean changes is little beside them.
void MeasureTorque(const RobotDraft& draft, StandingPosture* standing) {
  dynamics::TreeKinematics kinematics(draft.robot);
  kinematics.SetPosition(draft.robot.Configuration(standing->posture));
  const models::ContactPatch& sole = draft.robot.contacts[0];
  const double weight = kinematics.total_mass() * dynamics::kGravity;
  const Vector3d centre = kinematics.Position(sole.link, sole.Centre());
  for (const int joint : draft.left_leg) {
    const models::Joint& j = draft.robot.joints[joint];
    const Vector3d arm = centre - kinematics.X_WL()[joint + 1].translation();
    const double torque =
        std::abs(kinematics.Axis(joint + 1).dot(arm.cross(Vector3d(0, 0, weight))));
    if (torque / j.effort <= standing->torque) continue;
    standing->torque = torque / j.effort;
    standing->torque_joint = j.name;
  }
}

}  // namespace

std::optional<StandingPosture> StandWith(const RobotDraft& draft, const StandingChoice& choice,
                                         std::string* reason) {
  Stander stander(draft, choice);
  if (!stander.Stand(reason)) return std::nullopt;
  StandingPosture standing;
  standing.posture.root_height = stander.root_height();
  standing.posture.joints = stander.joints();
  standing.sole_distance = stander.sole_distance();
  MeasureTorque(draft, &standing);
  return standing;
}

}  // namespace possibility::actions
