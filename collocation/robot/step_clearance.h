#pragma once

#include <memory>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// Ground of height 0 before `begin` and of `height` beyond `end`, twice continuously
/// differentiable: between the two it follows the quintic 10 s^3 - 15 s^4 + 6 s^5.
struct SmoothStep {
  double begin = 0;  ///< m, along x
  double end = 1;    ///< m, greater than begin
  double height = 0;

  double Value(double x) const;      ///< m
  double Slope(double x) const;      ///< by x
  double Curvature(double x) const;  ///< by x twice, 1/m
};

/// Height of each point above the ground below it, m. Inputs: q.
/// @throws std::invalid_argument unless step.begin < step.end and the model is planar.
std::shared_ptr<Function> StepClearance(const RobotSystem& model,
                                        const std::vector<dynamics::ContactPoint>& points,
                                        const SmoothStep& step);

}  // namespace possibility::collocation
