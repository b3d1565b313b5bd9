#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "actions/plan/plan.h"
#include "actions/verify/plan_margins.h"
#include "models/robot/robot_model.h"
#include "models/world/environment.h"
#include "models/world/ground_map.h"

namespace possibility::experiments {

/// The verifier's margins (actions::PlanMargins) of the page's frames.
class FrameMargins {
 public:
  /// zmp, ground_edge, self_distance, obstacle_distance (m, to 0.01 mm), torque, friction,
  /// joint_speed (shares, to 1e-4); rounded so that strides repeat. Not a number where there is
  /// nothing to measure.
  using Numbers = Eigen::Matrix<double, 7, 1>;

  /// Both must outlive it. @throws InputError as GroundMap does.
  FrameMargins(const models::RobotModel& robot, const models::Environment& environment);

  /// The worst of each over the knots from `first` to `last`, so that a page that leaves out knots
  /// leaves out no peak.
  Numbers Worst(const actions::Phase& phase, std::size_t first, std::size_t last);

 private:
  models::GroundMap ground_;
  actions::InstantMargins instants_;
};

}  // namespace possibility::experiments
