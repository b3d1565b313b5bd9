#pragma once

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Bounds of strides for a leg's length and a sole: lengths grow with the leg, times with the root
/// of length over gravity, accelerations not at all. `stride` scales the lengths of strides,
/// `quickness` divides times.
models::GaitParameters ScaledParameters(const RobotDraft& draft, double stride, double quickness);

/// Speed that a walking robot of this size should reach, 0.15 sqrt(g l), m/s.
double ExpectedSpeed(const RobotDraft& draft);

}  // namespace possibility::actions
