#pragma once

#include <memory>
#include <vector>

#include "graph/action.h"
#include "graph/deadline.h"
#include "graph/find_path.h"

namespace possibility::graph {

/// By which reports name it.
inline constexpr const char* kStraightExplorer = "straight";

/// Asks every action in turn whether C_S lets it go straight from `start` to a goal. If one does,
/// the quickest of these paths of one edge goes into `result`, an empty one, as the answer to
/// everything; true then. False if none does, time is up, or a goal is where the start is.
bool GoStraight(const Point& start, const std::vector<Point>& goals,
                const std::vector<std::shared_ptr<const Action>>& actions, const Deadline& deadline,
                PathResult* result);

}  // namespace possibility::graph
