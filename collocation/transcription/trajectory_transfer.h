#pragma once

#include <Eigen/Core>

#include "collocation/transcription/trajectory.h"
#include "collocation/transcription/variable_layout.h"

namespace possibility::collocation {

/// @throws std::invalid_argument naming the phase of the trajectory that has another number of
/// quantities than the layout's problem.
void CheckFits(const VariableLayout& layout, const Trajectory& trajectory);

/// Samples a trajectory of the same problem, on any mesh and scheme, at the layout's points.
/// Variables are divided by their scales. @throws std::invalid_argument as CheckFits does.
Eigen::VectorXd VariablesOf(const VariableLayout& layout, const Trajectory& trajectory);

/// The motion that variables, divided by their scales, stand for.
Trajectory TrajectoryOf(const VariableLayout& layout, const Eigen::VectorXd& scaled);

}  // namespace possibility::collocation
