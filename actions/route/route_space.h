#pragma once

#include <memory>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/conditions/searched_manoeuvre.h"

namespace possibility::actions {

/// Input of a search for routes. Everything in it must outlive the search. Edges of routes number
/// their actions as the planner does: gaits, then manoeuvres.
struct RouteSpace {
  const LocomotionModel* model = nullptr;
  const std::vector<std::shared_ptr<QuasiStaticAction>>* gaits = nullptr;  ///< by gait
  const std::vector<std::shared_ptr<SearchedManoeuvre>>* manoeuvres = nullptr;
};

}  // namespace possibility::actions
