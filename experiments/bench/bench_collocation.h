#pragma once

#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Solves the regression suite, including `robot`'s problems, in variants that take turns. Ratios:
/// kkt_speedup (linear algebra with MUMPS over ours), exact_derivative_speedup (solves of the robot
/// problems with a differenced Jacobian and a limited-memory Hessian over those with exact
/// derivatives), exact_derivative_speedup_suite (the same for all problems), exact_hessian_speedup
/// (limited-memory over exact), two_thread_throughput. Then the walking step in space
/// (BenchSpatialStep). docs/collocation.md defines them.
BenchmarkReport BenchCollocation(const models::RobotModel& robot,
                                 const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
