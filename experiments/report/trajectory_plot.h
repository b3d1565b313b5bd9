#pragma once

#include <vector>

#include "collocation/study/stored_solution.h"
#include "experiments/report/svg_plot.h"

namespace possibility::experiments {

/// Coordinates, rates and controls over time, one above the other: the very polynomials of the
/// solution, dots at the knots, a line where a phase begins. Quantities that have one name in
/// several phases are one curve. What there is none of has no plot.
std::vector<Plot> TrajectoryPlots(const collocation::StoredSolution& solution);

}  // namespace possibility::experiments
