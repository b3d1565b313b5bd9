#pragma once

#include "actions/planner/plan_explanation.h"

namespace possibility::actions {

/// Names the narrowest place, " The narrowest place ..."; empty if there is none. `has_barrier`:
/// otherwise the floods still consider the way open.
std::string ExplainPassage(bool has_barrier, const std::optional<NarrowPassage>& passage);

}  // namespace possibility::actions
