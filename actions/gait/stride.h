#pragma once

#include <array>
#include <vector>

#include "actions/motion/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Classes of strides, by the directions that they displace the stance in. Each sweeps a volume of
/// its own (swept_volume.h).
enum class StrideClass {
  kStraight,  ///< forward or backward
  kSideways,  ///< to the left or to the right
  kOblique,   ///< both at once
  kTurn,      ///< on the spot
  kAny,       ///< turns on the way
};
inline constexpr std::array kStrideClasses = {StrideClass::kStraight, StrideClass::kSideways,
                                              StrideClass::kOblique, StrideClass::kTurn,
                                              StrideClass::kAny};

/// Whether a stride of this displacement (in the frame of the stance) belongs to `strides`. None at
/// all belongs to every class.
bool Includes(StrideClass strides, const PlanarPose& displacement);

/// Whether strides of the class leave the heading as it is.
bool KeepsHeading(StrideClass strides);

/// Fraction of a stride's bounds that a displacement (in the frame of the stance) uses.
double StrideEffort(const models::GaitParameters& parameters, const PlanarPose& displacement);

/// A gait goes straight from one stance to another in equal strides within its bounds. The class
/// that all of them belong to, the narrowest there is, and how many they are; 0 if the stances are
/// the same. The motion is made of these strides (PlanStrides), and sufficient conditions ask for
/// the room that they need.
StrideClass ClassOfStrides(const PlanarPose& from, const PlanarPose& to);
int StrideCount(const models::GaitParameters& parameters, const PlanarPose& from,
                const PlanarPose& to);

/// Stances that a gait places its limbs at on the way between two stances: the first is `from`,
/// the last has `to`'s position and heading (yaw continues from `from`, unwrapped); each
/// displacement is within the gait's bounds of one stride. Only `from` if `to` is the same stance.
std::vector<PlanarPose> PlanStrides(const models::GaitParameters& parameters,
                                    const PlanarPose& from, const PlanarPose& to);

}  // namespace possibility::actions
