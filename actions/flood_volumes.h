#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/locomotion_model.h"

namespace possibility::actions {

/// What the flood over C_S takes a gait to need: C_S of any motion through a stance holds only if
/// all boxes of at least one of these alternatives are free there. In the stance frame.
inline std::vector<std::vector<Eigen::AlignedBox3d>> FloodVolumes(const LocomotionModel& model,
                                                                  int gait) {
  return {model.gaits[gait]->sweep};
}

}  // namespace possibility::actions
