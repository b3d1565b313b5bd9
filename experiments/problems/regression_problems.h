#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collocation/study/optimal_control.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A solution that a problem may converge to. Where a problem has several extremals each has its
/// own name and value.
struct KnownOptimum {
  std::string name;  ///< "global", "second basin"
  double objective = 0;
  double tolerance = 0;  ///< relative: the digits that the source gives
};

/// An optimal-control problem whose answer is known from elsewhere.
struct RegressionProblem {
  std::string name;
  std::string source;  ///< of the problem and of its optimum
  std::vector<KnownOptimum> optima;
  std::function<std::unique_ptr<collocation::OptimalControlProblem>()> build;
  int intervals = 30;
  double mesh_tolerance = 0;  ///< 0: one mesh
  /// Where the optimal control jumps or is singular: trapezoidal, whose controls do not leave their
  /// bounds between the knots.
  collocation::TranscriptionScheme scheme = collocation::HermiteSimpson();
};

/// Every problem of the suite that needs no robot, in the order in which it is run.
std::vector<RegressionProblem> RegressionProblems();
/// The same and then those of a robot (RobotProblems).
std::vector<RegressionProblem> RegressionProblems(const models::RobotModel& humanoid);

}  // namespace possibility::experiments
