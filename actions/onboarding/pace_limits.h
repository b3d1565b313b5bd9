#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/gait/pace.h"
#include "actions/gait/pace_trial.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A pace of the family that FitPaces tries: multiples of the gait's `forward` and `swing_time`,
/// and a rise of the root as a share of its height.
Pace PaceOf(const models::Gait& gait, double length, double swing, double rise);

/// Says which of some paces of the family a robot's limits allow, and what forbids others.
class PaceLimits {
 public:
  /// Both must outlive this.
  PaceLimits(const models::RobotModel& robot, const NominalStance& stance);

  /// Whether such steps are possible at a pace of middling speed and some height of the root.
  bool AllowsStep(const PlanarPose& step, double clearance) const;

  /// Whether the slowest pace ahead of the family is possible at some height of the root.
  bool AllowsSlowestPace(double clearance) const;

  /// The quickest of some paces of the family that this clearance allows ahead, aside and in turns;
  /// none if there is none.
  std::optional<Pace> Quickest(double clearance) const;

  /// What a pace that is a tenth quicker than the quickest of `paces` would exceed, or the slowest
  /// one of the family if there are none.
  std::string BindingLimit(const std::vector<Pace>& paces) const;

 private:
  const NominalStance* stance_;
  PaceTrial trial_;
};

}  // namespace possibility::actions
