#include "actions/wholebody/self_clearance.h"

#include <algorithm>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// Links that are closer at rest may keep this share of their distance there.
constexpr double kShareOfRest = 0.9;

}  // namespace

SelfClearance::SelfClearance(const models::RobotModel& robot,
                             const std::vector<Eigen::VectorXd>& rests)
    : robot_(&robot), checker_(robot, models::Environment()) {
  for (const Eigen::VectorXd& q : rests) {
    const std::vector<models::Proximity> close =
        checker_.SelfProximities(Poses(q), 2 * kSelfClearance / kShareOfRest);
    close_at_rest_.insert(close_at_rest_.end(), close.begin(), close.end());
  }
}

std::vector<Eigen::Isometry3d> SelfClearance::Poses(const Eigen::VectorXd& q) const {
  dynamics::TreeKinematics kinematics(*robot_);
  kinematics.SetPosition(q);
  return kinematics.X_WL();
}

std::vector<SelfClearance::Fault> SelfClearance::Faults(const Eigen::VectorXd& q,
                                                        double clearance) const {
  return Faults(Poses(q), clearance);
}

std::vector<SelfClearance::Fault> SelfClearance::Faults(const std::vector<Eigen::Isometry3d>& X_WL,
                                                        double clearance) const {
  std::vector<Fault> faults;
  for (const models::Proximity& pair : checker_.SelfProximities(X_WL, clearance)) {
    double required = clearance;
    for (const models::Proximity& close : close_at_rest_) {
      if (close.link != pair.link || close.other != pair.other) continue;
      required = std::min(required, kShareOfRest * close.distance);
    }
    if (pair.distance < required) faults.push_back({pair, required});
  }
  return faults;
}

}  // namespace possibility::actions
