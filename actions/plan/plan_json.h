#pragma once

#include "actions/plan/plan.h"
#include "models/input/json_text.h"

namespace possibility::actions {

/// What stands before the segments in both formats of plan files. `folder`: paths are written as
/// seen from there. @throws std::invalid_argument if a number is not finite.
nlohmann::ordered_json PlanHead(const Plan& plan, const char* format,
                                const std::filesystem::path& folder);

/// What stands after them. @throws std::invalid_argument likewise.
nlohmann::ordered_json PlanTail(const Plan& plan);

}  // namespace possibility::actions
