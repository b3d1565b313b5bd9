#include "actions/onboarding/facing.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "actions/wholebody/limb_bend.h"
#include "models/facts/zero_poses.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

/// Of the sole's centre from the ankle, as a share of the sole's length: where feet leave no doubt.
constexpr double kClearly = 0.1;

/// By which the foot is ahead of the ankle, as a share of the sole's length, with all joints at 0.
double FootAhead(const RobotDraft& draft, int side) {
  const models::ContactPatch& patch = draft.robot.contacts[side];
  const Eigen::Isometry3d X_RF =
      models::PosesInRoot(draft.robot, VectorXd::Zero(draft.robot.num_joints()))[patch.link];
  const double ankle = X_RF.translation().x();
  double low = 0, high = 0;
  for (const Eigen::Vector3d& p : patch.points) {
    low = std::min(low, (X_RF * p).x() - ankle);
    high = std::max(high, (X_RF * p).x() - ankle);
  }
  return high > low ? (low + high) / (2 * (high - low)) : 0;
}

/// By which the ankle is behind the thigh's line with the knee in the middle of its range, m.
double AnkleBehind(const RobotDraft& draft, int side) {
  const std::vector<int>& leg = side == 0 ? draft.left_leg : draft.right_leg;
  const std::optional<LimbBend> bend = BendOf(draft.robot, {side, true, leg});
  if (!bend) return 0;
  VectorXd joints = VectorXd::Zero(draft.robot.num_joints());
  const models::Joint& knee = draft.robot.joints[leg[bend->joint]];
  const auto ankle = [&] {
    return models::PosesInRoot(draft.robot, joints)[bend->after].translation().x();
  };
  const double straight = ankle();
  if (std::isfinite(knee.lower + knee.upper)) {
    joints[leg[bend->joint]] = std::clamp(0.5 * (knee.lower + knee.upper), -1.0, 1.0);
  }
  return straight - ankle();
}

}  // namespace

bool FacesBackward(const RobotDraft& draft) {
  for (const int side : {0, 1}) {
    if (FootAhead(draft, side) > -kClearly || !(AnkleBehind(draft, side) < 0)) return false;
  }
  return true;
}

std::string WithTurnedRoot(const std::string& urdf, const std::string& root) {
  const std::size_t end = urdf.rfind("</robot>");
  if (end == std::string::npos) throw InputError("expected </robot> at the end of the URDF");
  std::string turned = urdf;
  const std::string frame = root + "_ahead";
  turned.insert(
      end, fmt::format("  <!-- x ahead: turned by half a turn, by `possibility robot init` -->\n"
                       "  <link name=\"{0}\"/>\n"
                       "  <joint name=\"{0}_joint\" type=\"fixed\">\n"
                       "    <origin xyz=\"0 0 0\" rpy=\"0 0 3.141592653589793\"/>\n"
                       "    <parent link=\"{0}\"/>\n    <child link=\"{1}\"/>\n  </joint>\n",
                       frame, root));
  return turned;
}

}  // namespace possibility::actions
