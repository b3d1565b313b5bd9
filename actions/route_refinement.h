#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "actions/quasi_static_action.h"
#include "actions/route.h"

namespace possibility::actions {

/// A quicker route through the positions of the found one: straight hops between any two of them,
/// executed heading forward or backward by the gait that the route starts with, or by another one
/// with a transition before and after, and turns in place between hops, as far as C_S allows. The
/// found legs remain a choice, so the result is never expected to be slower.
/// `actions`: by gait index. `keep_going`: asked now and then, may be empty; false ends with the
/// best route so far.
Route RefineRoute(const LocomotionModel& model, const Route& route,
                  const std::vector<std::shared_ptr<QuasiStaticAction>>& actions,
                  const std::function<bool()>& keep_going = {});

}  // namespace possibility::actions
