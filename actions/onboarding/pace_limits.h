#pragma once

#include <string>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace.h"
#include "actions/motion/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A pace of the family that DynamicGait tries: multiples of the gait's `forward` and `swing_time`,
/// and a rise of the root as a share of its height.
Pace PaceOf(const models::Gait& gait, double length, double swing, double rise);

/// What forbids four such steps with the margins of fitted paces; empty if nothing does.
std::string WhyNot(const DynamicGait& gait, const Pace& pace, const PlanarPose& step);

/// What a pace that is a tenth quicker than the quickest one would exceed, or the slowest one of
/// the family if none fits.
std::string BindingLimit(const DynamicGait& gait, const models::Gait& of);

}  // namespace possibility::actions
