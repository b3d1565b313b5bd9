#include "experiments/viewer/viewer_balance.h"

#include <cmath>

#include "actions/verify/zero_moment_point.h"

namespace possibility::experiments {
namespace {

constexpr double kLightLoad = 1e-3;  // of the weight, as actions::MeasureMargins has it

/// The bearing points in the order of Knot::forces.
Eigen::Matrix3Xd Points(const std::vector<actions::BearingPatch>& bearing,
                        const dynamics::TreeKinematics& kinematics, Eigen::Index count) {
  Eigen::Matrix3Xd points(3, count);
  Eigen::Index next = 0;
  for (const actions::BearingPatch& part : bearing) {
    const models::ContactPatch& patch = kinematics.model().contacts[part.patch];
    for (const int point : part.points) {
      points.col(next++) = kinematics.Position(patch.link, patch.points[point]);
    }
  }
  return points;
}

}  // namespace

BalanceState BalanceStateAt(const std::vector<actions::BearingPatch>& bearing,
                            const Eigen::Matrix3Xd& forces, const CentroidalState& whole,
                            const dynamics::TreeKinematics& kinematics) {
  BalanceState state;
  const Eigen::Matrix3Xd points = Points(bearing, kinematics, forces.cols());
  const double mass = kinematics.total_mass();
  const auto zmp = actions::ZeroMomentPoint(points, forces, kLightLoad * mass * dynamics::kGravity);
  if (!zmp) return state;
  state.zmp = *zmp;
  state.margin = actions::SupportMargin(points, zmp->head<2>());
  const double height = whole.position.z() - zmp->z();
  if (height > 0) {
    const double omega = std::sqrt(dynamics::kGravity / height);
    state.capture = (whole.position + whole.linear / (mass * omega)).head<2>();
  }
  return state;
}

}  // namespace possibility::experiments
