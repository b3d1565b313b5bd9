#pragma once

#include <memory>
#include <vector>

#include "collocation/function.h"
#include "dynamics/multibody_dynamics.h"

namespace possibility::collocation {

/// A planar multibody system as functions of one instant, with exact first and second derivatives
/// from dynamics/. q, v, a, f are stacked in that order; f has a horizontal (x) and a vertical (z)
/// component per contact point, world axes, N, on the robot. Each function keeps a workspace of its
/// own. @throws std::invalid_argument unless the model's base is planar.
using PlanarModel = std::shared_ptr<const dynamics::MultibodyModel>;

/// ID(q, v, a) - J' f; nv outputs, base rows first. Zero in the base rows is the equation of
/// motion, the joint rows are the joint torques. Inputs: q, v, a, f of all points.
std::shared_ptr<Function> EquationOfMotion(const PlanarModel& model,
                                           const std::vector<dynamics::ContactPoint>& points);

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

/// M(q) (v+ - v-) - J' impulses: nv outputs, zero at an impact. Inputs: q, v-, v+, impulses (x, z
/// of each point, N s).
std::shared_ptr<Function> ImpactMap(const PlanarModel& model,
                                    const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
