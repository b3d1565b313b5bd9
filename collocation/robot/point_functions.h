#pragma once

#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// x, z of each point. Inputs: q.
std::shared_ptr<Function> PointPositions(const PlanarModel& model,
                                         const std::vector<dynamics::ContactPoint>& points);

/// The squared distance of two points of the system, m^2. Inputs: q.
std::shared_ptr<Function> SquaredDistance(const PlanarModel& model,
                                          const dynamics::ContactPoint& from,
                                          const dynamics::ContactPoint& to);

/// Velocities, x and z of each point. Inputs: q, v.
std::shared_ptr<Function> PointVelocities(const PlanarModel& model,
                                          const std::vector<dynamics::ContactPoint>& points);

/// Accelerations, x and z of each point. Inputs: q, v, a.
std::shared_ptr<Function> PointAccelerations(const PlanarModel& model,
                                             const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
