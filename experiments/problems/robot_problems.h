#pragma once

#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {

/// Problems of a humanoid with DRC-HUBO1's joint names.
std::vector<RegressionProblem> RobotProblems(const models::RobotModel& humanoid);

}  // namespace possibility::experiments
