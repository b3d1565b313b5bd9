#pragma once

#include <vector>

#include "collocation/study/stored_solution.h"
#include "experiments/report/svg_plot.h"

namespace possibility::experiments {

/// Coordinates, rates and controls over time, one above the other: the solution's polynomials, dots
/// at the knots, a line at the start of a phase. Quantities with the same name in several phases
/// form one curve. Groups without quantities have no plot.
std::vector<Plot> TrajectoryPlots(const collocation::StoredSolution& solution);

}  // namespace possibility::experiments
