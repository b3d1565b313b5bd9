#pragma once

#include <memory>
#include <vector>

#include "graph/action.h"
#include "graph/deadline.h"
#include "graph/find_path.h"

namespace possibility::graph {

/// Name of this explorer in reports.
inline constexpr const char* kStraightExplorer = "straight";

/// Asks every action in turn whether C_S lets it go straight from `start` to a goal. If so, writes
/// the quickest of these one-edge paths, as a complete answer, into `result` (which must be empty)
/// and returns true. False if no action can, time is up, or a goal equals the start.
bool GoStraight(const Point& start, const std::vector<Point>& goals,
                const std::vector<std::shared_ptr<const Action>>& actions, const Deadline& deadline,
                PathResult* result);

}  // namespace possibility::graph
