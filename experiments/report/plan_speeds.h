#pragma once

#include <string>
#include <utility>
#include <vector>

#include "actions/plan/plan.h"

namespace possibility::experiments {

/// How far an action leads and how long it takes, over all its segments. Lengths are those of the
/// root link's path in the x-y plane, straight from the start to the end of each segment, so that
/// sway does not count.
struct ActionWay {
  std::string action;
  double length = 0;    ///< m
  double duration = 0;  ///< s
};

/// In the order in which the actions begin. Actions that lead nowhere, such as a turn on the spot,
/// are left out.
std::vector<ActionWay> WaysByAction(const actions::Plan& plan);

/// Length of the way of all segments, m.
double PlanarLength(const actions::Plan& plan);

/// Mean speeds of WaysByAction, m/s.
std::vector<std::pair<std::string, double>> SpeedsByAction(const actions::Plan& plan);

}  // namespace possibility::experiments
