#include "actions/onboarding/arm_posture.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "models/facts/zero_poses.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr int kArmSamples = 400;
constexpr double kArmClearance = 0.06;  // of the leg's length, between arms and the rest
constexpr double kLimitMargin = 0.05;   // rad, from the limits
constexpr double kArmSpread = 0.9;      // rad, standard deviation of the last samples

class ArmSearch {
 public:
  explicit ArmSearch(const RobotDraft& draft)
      : draft_(draft), checker_(draft.robot, models::Environment()) {
    for (const auto* arm : {&draft.left_arm, &draft.right_arm}) {
      for (const int joint : *arm) links_.insert(joint + 1);
    }
  }

  VectorXd Best(const VectorXd& standing) const {
    const double wanted = kArmClearance * draft_.leg_length;
    std::mt19937 random(2);
    VectorXd best = WithArms(standing, VectorXd::Zero(draft_.left_arm.size()));
    double least = Cost(best, wanted);
    for (int i = 0; i < kArmSamples; ++i) {
      std::normal_distribution<double> normal(0, kArmSpread * (i + 1) / kArmSamples);
      VectorXd arm(draft_.left_arm.size());
      for (double& value : arm) value = normal(random);
      const VectorXd joints = WithArms(standing, arm);
      const double cost = Cost(joints, wanted);
      if (cost < least) {
        least = cost;
        best = joints;
      }
    }
    return best;
  }

 private:
  /// Within the limits of both sides.
  VectorXd WithArms(const VectorXd& standing, const VectorXd& arm) const {
    VectorXd joints = standing;
    for (std::size_t i = 0; i < draft_.left_arm.size(); ++i) {
      const int left = draft_.left_arm[i];
      joints[left] = Within(left, arm[static_cast<int>(i)]);
      for (const auto& pair : draft_.pairs.pairs) {
        if (pair.left == left) joints[pair.right] = Within(pair.right, pair.sign * joints[left]);
      }
    }
    return joints;
  }

  double Within(int joint, double value) const {
    const models::Joint& j = draft_.robot.joints[joint];
    const double margin = std::min(kLimitMargin, 0.25 * (j.upper - j.lower));
    return std::clamp(value, j.lower + margin, j.upper - margin);
  }

  /// Distance from zero; much more for links that are too close.
  double Cost(const VectorXd& joints, double wanted) const {
    double cost = 0;
    for (const int joint : draft_.left_arm) cost += joints[joint] * joints[joint];
    for (const models::Proximity& pair :
         checker_.SelfProximities(models::PosesInRoot(draft_.robot, joints), wanted)) {
      const bool one = links_.contains(pair.link), other = links_.contains(pair.other);
      if (!one && !other) continue;
      // Neighbours in an arm are near each other by build.
      if (one && other && std::abs(pair.link - pair.other) <= 2) continue;
      const double lack = (wanted - pair.distance) / wanted;
      cost += 30 * lack + (pair.distance < 0 ? 100 : 0);
    }
    return cost;
  }

  const RobotDraft& draft_;
  models::CollisionChecker checker_;
  std::set<int> links_;
};

}  // namespace

VectorXd PostureWithArms(const RobotDraft& draft, const VectorXd& joints) {
  if (draft.left_arm.empty()) return joints;
  return ArmSearch(draft).Best(joints);
}

}  // namespace possibility::actions
