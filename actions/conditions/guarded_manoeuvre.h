#pragma once

#include <memory>
#include <string>

#include "actions/conditions/manoeuvre.h"

namespace possibility::actions {

/// `manoeuvre`, whose conditions and extensions may be faulty: what one of them throws comes out
/// as an InputError, in one line that begins with `where` and names the action, the function and
/// the pose. Jobs and motions keep what they throw, which costs an edge, not the plan. What is
/// recorded stays with `manoeuvre`. Abandoned passes.
std::shared_ptr<Manoeuvre> Guarded(const PlanningContext& context,
                                   std::shared_ptr<Manoeuvre> manoeuvre, std::string where);

}  // namespace possibility::actions
