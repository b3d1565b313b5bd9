#pragma once

#include <optional>

#include "actions/plan/plan.h"
#include "actions/rollout/rollout_gains.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A symmetric motion, and the robot folded onto its sagittal plane that makes it: the two joints
/// of a pair are one with both motors, the two links they move one with both masses. The plane of a
/// symmetric robot moves exactly as the whole robot does, with a third of the coordinates. The root
/// floats in space, and the contacts of both sides are where they were.
struct FoldedMotion {
  models::RobotModel robot;  ///< no gaits, no transitions, no pairs
  Segment motion;
  RolloutGains gains;  ///< those of the whole robot; of a pair, the sum
};

/// The motion's part in the plane y = 0, along x; of pairs, the means. None if the motion departs
/// from that by more than 0.05 rad or m.
std::optional<FoldedMotion> FoldMotion(const dynamics::SagittalReduction& reduction,
                                       const Segment& motion, const RolloutGains& gains = {});

}  // namespace possibility::actions
