#pragma once

#include "actions/planner/plan_explanation.h"

namespace possibility::actions {

/// Where the way is narrowest, " The narrowest place ...", or nothing if there is no such place.
/// `status`: one of the "no"s; at the time limit the floods believe in the way.
std::string ExplainPassage(PlanStatus status, const std::optional<NarrowPassage>& passage);

}  // namespace possibility::actions
