#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/regression/regression_run.h"
#include "experiments/report/svg_plot.h"

namespace possibility::experiments {

/// What a problem costs on fixed meshes, and how near its known optimum the answers come: by
/// hermite_simpson, its compressed form and trapezoidal, on a quarter, half, once, twice and four
/// times the problem's own intervals. A scheme or a number of intervals in `options` takes the
/// place of these three, or of the problem's own number. Times are the least of three solves, or of
/// fewer once they took a second.
/// `progress` gets the number of meshes done and of all.
std::vector<WorkPrecisionPoint> MeasureWorkPrecision(const RegressionProblem& problem,
                                                     const RegressionOptions& options,
                                                     const std::function<void(int, int)>& progress);

/// The relative error over the time, one curve for each scheme; where the digits of the known
/// optimum end, a dashed line.
Plot WorkPrecisionPlot(const RegressionRecord& record);

}  // namespace possibility::experiments
