#pragma once

#include <optional>
#include <vector>

#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "common/cancellation_token.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A joint between the root and the trunk above.
struct Waist {
  int joint = 0;
  double sign = 1;  ///< 1: its axis points up; -1: down
};

struct PatternSettings {
  double clearance = 0.05;  ///< height of a swing in its middle, m
  /// By interval of the schedule, m: how far swings that begin there pass above the higher of their
  /// ends; 0: as `clearance` says. Empty: all 0.
  std::vector<double> lifts;
  double zmp_margin =
      0.05;  ///< wanted distance of the zero moment point from the support's edge, m
  /// m: the zero moment point of swings is so far ahead of the balanced place, within the margin.
  /// Bent knees, which are ahead of the ankles, then need less torque.
  double zmp_ahead = 0;
  /// Knots of the centre of mass: s apart, at most, and at least so many steps between them in
  /// every interval. Where a plan has knots at the same instants, forces are almost linear between
  /// them.
  double grid = 0.02;
  int least_steps = 1;
  int filter_passes = 2;  ///< corrections of the pendulum by the whole robot's dynamics
  /// Corrections before the last one look at one knot of so many: they are only roughly right
  /// anyway.
  int coarse_stride = 1;
  double rise = 0;  ///< m: height of the root above the stance's, between start and end
  /// The root is lowered where the limbs need it to reach their places; `rise` is then the most
  /// that it is higher. Always so on uneven ground, and with `lifts`.
  bool keeps_reach = false;
  double lean = 0;  ///< rad: pitch of the root beyond the stance's, forward, like `rise`
  /// rad, for each interval of the schedule; empty: none. Roll of the root towards the limbs that
  /// bear in a swing. The trunk comes over them, which spares a hip that must hold it up sideways,
  /// and leaves the limb that swings more of its hip's range.
  std::vector<double> sways;
  double turn = 0;  ///< rad: yaw of the root at the end of a swing, with its side ahead
  /// rad: the trunk above the waist turns the other way against the root. Swinging legs then ask
  /// less of the friction.
  double twist = 0;
  std::optional<Waist> waist;  ///< for `twist`
  double evenness = 1;         ///< of the speed of swings that are not high (EvenRestToRest)
  /// For each interval of the schedule, 0 to 1; empty: 1. How much of `evenness`, `zmp_ahead`,
  /// `turn` and `twist` a swing has: all for a full step ahead, none for a step aside.
  std::vector<double> shares;
  double rise_time = 0.35;  ///< s: to get there from the start, and back to the end; at most half
  /// s, between the coefficients of the root's height where the ground is uneven or swings are high
  /// (SmoothUnder). More is gentler, less follows the limbs' reach more closely.
  double height_spacing = 0.12;
  /// num_joints, at the end; those of limbs as in the nominal posture. Empty: that posture.
  Eigen::VectorXd end_joints;
  double turning_time = 1;  ///< s: for the joints to get there; at most the whole motion
};

/// The whole body's motion of a contact schedule on surfaces of any height and tilt, without an
/// optimiser: the centre of mass follows the linear inverted pendulum over a zero moment
/// point inside the support, and a dynamic filter (Kajita et al. 2003) replaces the pendulum's
/// error by that of the whole robot. From rest to rest in the nominal posture, or with `end_joints`
/// at the end; in between the root may be higher, and it rises and falls with the supports.
/// docs/gaits.md has the formulas. `stance`: posture, and the limbs that are `schedule`'s contacts,
/// in the same order. The result keeps copies of all it needs but `stance`'s gait.
/// @throws std::invalid_argument if the schedule is none (models::CheckContactSchedule), is of
/// other contacts, has fewer than two intervals, or a limb swings in the first or the last;
/// MotionError if a task is out of reach; Cancelled.
std::vector<MotionPhase> PatternPhases(const models::RobotModel& robot, const NominalStance& stance,
                                       const models::ContactSchedule& schedule,
                                       const PatternSettings& settings,
                                       const CancellationToken& cancellation = {});

}  // namespace possibility::actions
