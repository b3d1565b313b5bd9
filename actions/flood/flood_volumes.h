#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/conditions/locomotion_model.h"

namespace possibility::actions {

/// Necessary volumes of a gait for the flood over C_S: C_S of any motion through a stance holds
/// only if all boxes of at least one of these alternatives are free there. In the stance frame. The
/// standing volume is enough, because every swept volume contains it (GaitVolumes).
inline std::vector<std::vector<Eigen::AlignedBox3d>> FloodVolumes(const LocomotionModel& model,
                                                                  int gait) {
  return {model.gaits[gait]->volumes.standing};
}

/// Alternative volumes for passing a place: strides ahead or sideways.
inline std::vector<std::vector<Eigen::AlignedBox3d>> PassageVolumes(const LocomotionModel& model,
                                                                    int gait) {
  const GaitVolumes& volumes = model.gaits[gait]->volumes;
  return {volumes.sweep(StrideClass::kStraight), volumes.sweep(StrideClass::kSideways)};
}

}  // namespace possibility::actions
