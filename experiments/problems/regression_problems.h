#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collocation/study/optimal_control.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A solution to which a problem may converge. If a problem has several extremals, each has its own
/// name and value.
struct KnownOptimum {
  std::string name;  ///< "global", "second basin"
  double objective = 0;
  double tolerance = 0;  ///< relative: from the digits in the source
};

/// An optimal-control problem with a known answer from another source.
struct RegressionProblem {
  std::string name;
  std::string source;  ///< of the problem and of its optimum
  std::vector<KnownOptimum> optima;
  std::function<std::unique_ptr<collocation::OptimalControlProblem>()> build;
  int intervals = 30;
  double mesh_tolerance = 0;  ///< 0: one mesh
  /// Trapezoidal if the optimal control jumps or is singular, because its controls stay within
  /// their bounds between the knots.
  collocation::TranscriptionScheme scheme = collocation::HermiteSimpson();
};

/// All problems of the suite that need no robot, in the order of running.
std::vector<RegressionProblem> RegressionProblems();
/// The same, followed by those of a robot (RobotProblems).
std::vector<RegressionProblem> RegressionProblems(const models::RobotModel& humanoid);

}  // namespace possibility::experiments
