#pragma once

#include <memory>
#include <vector>

#include "common/deadline.h"
#include "graph/action/action.h"
#include "graph/search/find_path.h"

namespace possibility::graph {

/// Name of this explorer in reports.
inline constexpr const char* kStraightExplorer = "straight";

/// Tests C_S of the straight edge from `start` to each goal with every action in turn. If it holds
/// for some, writes the quickest of these one-edge paths as the complete answer into `result`
/// (which must be empty) and returns true. Returns false if it holds for none, time is up, or a
/// goal equals the start.
bool GoStraight(const Point& start, const std::vector<Point>& goals,
                const std::vector<std::shared_ptr<const Action>>& actions, const Deadline& deadline,
                PathResult* result);

}  // namespace possibility::graph
