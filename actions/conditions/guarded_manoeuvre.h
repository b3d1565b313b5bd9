#pragma once

#include <memory>
#include <string>

#include "actions/conditions/manoeuvre.h"

namespace possibility::actions {

/// Wraps `manoeuvre`, whose conditions and extensions may be faulty. An exception from one of them
/// becomes an InputError of one line that begins with `where` and names the action, the function
/// and the pose; Abandoned passes through. Exceptions from jobs and motions stay as they are: they
/// cost an edge, not the plan. Verdicts are recorded in `manoeuvre`.
std::shared_ptr<Manoeuvre> Guarded(const PlanningContext& context,
                                   std::shared_ptr<Manoeuvre> manoeuvre, std::string where);

}  // namespace possibility::actions
