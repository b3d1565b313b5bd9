#pragma once

#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// The torque of an independent joint plus `slope` times its rate: bounded where the joint has a
/// torque-speed line (models::TorqueSpeedLine).
struct TorqueSpeedRow {
  int joint = 0;     ///< independent one of the model
  double slope = 0;  ///< N m s/rad or N s/m
};

/// ID(q, v, a) - J' f; nv outputs, base rows first, and one more for each of `rows`. The equation
/// of motion is that the base rows are zero; the joint rows are the joint torques. Inputs: q, v, a,
/// f of all points.
std::shared_ptr<Function> EquationOfMotion(const RobotSystem& model,
                                           const std::vector<dynamics::ContactPoint>& points,
                                           const std::vector<TorqueSpeedRow>& rows = {});

/// ID(q, v, a) - J' f - S tau, with the joint torques tau as inputs after f: the equation of motion
/// is that all nv outputs are zero.
std::shared_ptr<Function> ActuatedMotion(const RobotSystem& model,
                                         const std::vector<dynamics::ContactPoint>& points);

/// M(q) (v+ - v-) - J' impulses: nv outputs, zero at an impact. Inputs: q, v-, v+, impulses (the
/// components of each point, N s).
std::shared_ptr<Function> ImpactMap(const RobotSystem& model,
                                    const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
