#pragma once

#include <string>
#include <vector>

#include "models/shapes/shape.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// Names of the obstacles that touch any of `shapes` (posed in the world). For messages: slow.
std::vector<std::string> Blockers(const models::Environment& environment,
                                  const std::vector<models::PosedShape>& shapes);

}  // namespace possibility::actions
