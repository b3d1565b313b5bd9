#pragma once

#include <string>
#include <vector>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "actions/wholebody/self_clearance.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Clearance between links with which paces are fitted, and the one that motions fall back to with
/// a little to spare, m.
inline constexpr double kFittedClearance = kSelfClearance + 0.0005;
inline constexpr double kTightClearance = 0.0055;

/// Tries equal steps of a gait at a pace, four unless told otherwise, with margins for bends and
/// unequal steps: joints and torques keep 92 % of their limits.
class PaceTrial {
 public:
  /// Both must outlive this.
  PaceTrial(const models::RobotModel& robot, const NominalStance& stance);

  /// What forbids such steps: a joint, a torque, contact forces or two links; empty if nothing
  /// does. `clearance`: between links, m, at least 0.005.
  std::string WhyNot(const Pace& pace, const PlanarPose& step, double clearance) const;
  bool Allows(const Pace& pace, const PlanarPose& step) const {
    return WhyNot(pace, step, kFittedClearance).empty();
  }

  /// The greatest share of their margins that joint speeds, torques and clearances of such steps
  /// use: above 1, a limit is exceeded. Infinite if there is no such motion at all, whatever the
  /// joints can do, or if its contacts need 92 % of the friction that motions may use.
  double Load(const Pace& pace, const PlanarPose& step, int steps = kSteps) const;

 private:
  static constexpr int kSteps = 4;

  std::vector<Phase> Motion(const Pace& pace, const PlanarPose& step, int steps,
                            const MotionSettings& settings) const;
  std::string CloseLinks(const std::vector<Phase>& motion, double clearance) const;
  double LoadOf(const Knot& knot) const;

  const models::RobotModel* robot_;
  DynamicGait gait_;  ///< without paces of its own
  SelfClearance clearance_;
};

}  // namespace possibility::actions
