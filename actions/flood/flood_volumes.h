#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/conditions/locomotion_model.h"

namespace possibility::actions {

/// What the flood over C_S takes a gait to need: C_S of any motion through a stance holds only if
/// all boxes of at least one of these alternatives are free there. In the stance frame. Wherever a
/// way leads, there is room to stand: every swept volume holds that (GaitVolumes).
inline std::vector<std::vector<Eigen::AlignedBox3d>> FloodVolumes(const LocomotionModel& model,
                                                                  int gait) {
  return {model.gaits[gait]->volumes.standing};
}

/// What a gait needs to get through somewhere: room for one of these, strides ahead or sideways.
inline std::vector<std::vector<Eigen::AlignedBox3d>> PassageVolumes(const LocomotionModel& model,
                                                                    int gait) {
  const GaitVolumes& volumes = model.gaits[gait]->volumes;
  return {volumes.sweep(StrideClass::kStraight), volumes.sweep(StrideClass::kSideways)};
}

}  // namespace possibility::actions
