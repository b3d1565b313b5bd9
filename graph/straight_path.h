#pragma once

#include <memory>
#include <vector>

#include "graph/action.h"
#include "graph/deadline.h"
#include "graph/find_path.h"

namespace possibility::graph {

/// Asks every action in turn whether C_S lets it go straight from `start` to a goal. If one does,
/// this path of one edge goes into `result`, an empty one, as the answer to everything; true then.
/// False if none does, or time is up.
bool GoStraight(const Point& start, const std::vector<Point>& goals,
                const std::vector<std::shared_ptr<const Action>>& actions, const Deadline& deadline,
                PathResult* result);

}  // namespace possibility::graph
