#include "actions/onboarding/leg_measures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "models/facts/zero_poses.h"
#include "models/input/input_error.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kShortestLeg = 0.02;  // m

/// Of points in a direction in the plane, m.
double ExtentAlong(const std::vector<Vector3d>& points, const Eigen::Matrix3d& level,
                   double angle) {
  const Vector3d direction(std::cos(angle), std::sin(angle), 0);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& p : points) {
    low = std::min(low, direction.dot(level * p));
    high = std::max(high, direction.dot(level * p));
  }
  return high - low;
}

}  // namespace

void MeasureLegs(RobotDraft* draft) {
  const std::vector<Eigen::Isometry3d> X_RL =
      models::PosesInRoot(draft->robot, Eigen::VectorXd::Zero(draft->robot.num_joints()));
  const models::ContactPatch& left = draft->robot.contacts[0];
  const Vector3d sole = X_RL[left.link] * left.Centre();
  const Vector3d hip = X_RL[draft->left_leg.front() + 1].translation();
  draft->leg_length = hip.z() - sole.z();
  if (!(draft->leg_length > kShortestLeg)) {
    throw InputError(fmt::format("{}: the soles are not below the hips with all joints at 0",
                                 draft->urdf_file.string()));
  }
  const Eigen::Matrix3d R_RL = X_RL[left.link].linear();
  const Eigen::Matrix3d level =
      models::SmallestRotation(R_RL * left.normal_L, -Vector3d::UnitZ()) * R_RL;
  draft->sole_breadth = ExtentAlong(left.points, level, std::numbers::pi / 2);
  draft->sole_width = draft->sole_breadth;
  for (int i = 0; i < 36; ++i) {
    draft->sole_width =
        std::min(draft->sole_width, ExtentAlong(left.points, level, i * std::numbers::pi / 36));
  }
}

}  // namespace possibility::actions
