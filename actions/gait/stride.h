#pragma once

#include <array>
#include <vector>

#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Classes of strides, by the direction of the stance's displacement. Each class has its own swept
/// volume (swept_volume.h).
enum class StrideClass {
  kStraight,  ///< forward or backward
  kSideways,  ///< to the left or to the right
  kOblique,   ///< both at once
  kTurn,      ///< on the spot
  kAny,       ///< any stride, including turns on the way
};
inline constexpr std::array kStrideClasses = {StrideClass::kStraight, StrideClass::kSideways,
                                              StrideClass::kOblique, StrideClass::kTurn,
                                              StrideClass::kAny};

/// Whether a stride of this displacement (in the stance frame) belongs to `strides`. A displacement
/// of zero belongs to every class.
bool Includes(StrideClass strides, const PlanarPose& displacement);

/// Whether strides of the class keep the heading.
bool KeepsHeading(StrideClass strides);

/// Fraction of a stride's bounds that a displacement (in the stance frame) uses.
double StrideEffort(const models::GaitParameters& parameters, const PlanarPose& displacement);

/// A gait goes straight from one stance to another in equal strides within its bounds. These
/// functions return the narrowest class that holds all of the strides, and their number (0 if the
/// stances are the same). The motion consists of these strides (PlanStrides), and C_S tests their
/// swept volume.
StrideClass ClassOfStrides(const PlanarPose& from, const PlanarPose& to);
int StrideCount(const models::GaitParameters& parameters, const PlanarPose& from,
                const PlanarPose& to);

/// Stances of a gait's strides on the way between two stances. The first is `from`; the last has
/// `to`'s position and heading (yaw continues from `from`, unwrapped). Each displacement is within
/// the gait's bounds of one stride. Only `from` if `to` is the same stance.
std::vector<PlanarPose> PlanStrides(const models::GaitParameters& parameters,
                                    const PlanarPose& from, const PlanarPose& to);

}  // namespace possibility::actions
