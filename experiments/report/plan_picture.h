#pragma once

#include <string>

#include "actions/plan/plan.h"
#include "models/world/environment.h"

namespace possibility::experiments {

/// The scene from above as an SVG document: ground, obstacles, the explored graph in thin lines and
/// the path of the pelvis, coloured by action. Without segments: no path.
std::string PlanPicture(const actions::Plan& plan, const models::Environment& environment,
                        double width = 420);

}  // namespace possibility::experiments
