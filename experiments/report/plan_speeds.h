#pragma once

#include <string>
#include <utility>
#include <vector>

#include "actions/plan/plan.h"

namespace possibility::experiments {

/// Length of the root link's path in the x-y plane, m: straight from the start to the end of each
/// segment, so that sway does not count.
double PlanarLength(const actions::Plan& plan);

/// By action, in the order in which they begin: mean speed over its segments, m/s. Actions that
/// lead nowhere, such as a turn on the spot, are left out.
std::vector<std::pair<std::string, double>> SpeedsByAction(const actions::Plan& plan);

}  // namespace possibility::experiments
