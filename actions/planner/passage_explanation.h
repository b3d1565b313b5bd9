#pragma once

#include "actions/planner/plan_explanation.h"

namespace possibility::actions {

/// Names the narrowest place, " The narrowest place ..."; empty if there is none. `status`: one of
/// the "no"s. At the time limit the floods still consider the way open.
std::string ExplainPassage(PlanStatus status, const std::optional<NarrowPassage>& passage);

}  // namespace possibility::actions
