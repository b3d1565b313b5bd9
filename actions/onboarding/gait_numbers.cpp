#include "actions/onboarding/gait_numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

// Of the leg's length, of sqrt(leg length / g), and of g.
constexpr double kForward = 0.26;
constexpr double kLateral = 0.11;
constexpr double kTurn = 10 * std::numbers::pi / 180;  // rad
constexpr double kClearance = 0.06;
constexpr double kMarginOfLeg = 0.052;
constexpr double kSwing = 1.75;
constexpr double kShift = 1.05;
constexpr double kAcceleration = 0.08;

/// Of the sole's least half width: the zero moment point keeps this from the edge at most.
constexpr double kMarginInSole = 0.55;

}  // namespace

models::GaitParameters ScaledParameters(const RobotDraft& draft, double stride, double quickness) {
  const double length = draft.leg_length;
  const double time = std::sqrt(length / dynamics::kGravity) / quickness;
  models::GaitParameters parameters;
  parameters.forward = kForward * stride * length;
  parameters.lateral = kLateral * stride * length;
  parameters.turn = kTurn * stride;
  parameters.clearance = kClearance * length;
  parameters.com_margin = std::min(kMarginOfLeg * length, kMarginInSole * 0.5 * draft.sole_width);
  parameters.swing_time = kSwing * time;
  parameters.com_acceleration = kAcceleration * dynamics::kGravity;
  parameters.minimum_shift_time = kShift * time;
  return parameters;
}

double ExpectedSpeed(const RobotDraft& draft) {
  return 0.15 * std::sqrt(dynamics::kGravity * draft.leg_length);
}

}  // namespace possibility::actions
