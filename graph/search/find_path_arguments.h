#pragma once

#include <memory>
#include <vector>

#include "graph/action/action.h"
#include "graph/search/find_path.h"

namespace possibility::graph {

/// Checks the arguments of FindPath.
/// @throws std::invalid_argument that names the wrong argument and what is expected of it.
void CheckFindPathArguments(const Point& start, const std::vector<Point>& goals,
                            const std::vector<std::shared_ptr<const Action>>& actions,
                            const FindPathSettings& settings);

}  // namespace possibility::graph
