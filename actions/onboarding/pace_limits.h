#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "actions/wholebody/self_clearance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A pace of the family that DynamicGait tries: multiples of the gait's `forward` and `swing_time`,
/// and a rise of the root as a share of its height.
Pace PaceOf(const models::Gait& gait, double length, double swing, double rise);

/// Clearance with which DynamicGait fits paces, and the one that its motions fall back to with a
/// little to spare, m.
inline constexpr double kFittedClearance = kSelfClearance + 0.0005;
inline constexpr double kTightClearance = 0.0055;

/// Says what forbids steps of a gait at a pace, as DynamicGait fits paces.
class PaceLimits {
 public:
  /// Both must outlive this.
  PaceLimits(const models::RobotModel& robot, const NominalStance& stance);

  /// What forbids four such steps with the margins of fitted paces: a joint, a torque, contact
  /// forces or two links; empty if nothing does.
  /// `clearance`: between links, m, at least 0.005.
  std::string WhyNot(const Pace& pace, const PlanarPose& step, double clearance) const;

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
  std::string CloseLinks(const std::vector<Phase>& motion, double clearance) const;

  const models::RobotModel* robot_;
  const NominalStance* stance_;
  DynamicGait gait_;  ///< without paces of its own
  SelfClearance clearance_;
};

}  // namespace possibility::actions
