#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actions/locomotion_model.h"
#include "actions/manoeuvre_bounds.h"
#include "actions/plan.h"
#include "actions/quasi_static_action.h"

namespace possibility::actions {

struct FloodResult {
  /// False is a proof at any resolution: every cell errs towards open, so no continuous path
  /// crosses a closed barrier of cells. True only says that this resolution finds no barrier.
  bool route_may_exist = true;
  /// If there is none: what the flood filled, and what closes the cells just beyond the closest.
  Barrier barrier;
  std::int64_t cells = 0;  ///< tested
};

/// What a manoeuvre adds to the flood over C_S: which landing stances a launch stance leads to
/// (ManoeuvreBounds::landings, which must be there).
struct FloodManoeuvre {
  int from = 0;  ///< gaits
  int to = 0;
  std::function<std::optional<LandingRange>(double rise)> landings;
};

/// `keep_going` of both floods: asked at every cell, may be empty; false ends the flood without a
/// proof (route_may_exist).
///
/// Flood over what can be confirmed: cells of (gait, x, y, heading) in which C_S may hold
/// somewhere, with shapes shrunk by the size of a cell, joined through transitions and manoeuvres.
/// Without manoeuvres nobody leaves the height of the start. `halvings`: how often a cell is halved
/// along every axis before it counts as open where that is in doubt; each takes more time, and a
/// narrower passage for closed.
FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            double resolution, const std::function<bool()>& keep_going = {},
                            const std::vector<FloodManoeuvre>& manoeuvres = {}, int halvings = 0);

/// Flood over C_N: cells of the position of the largest ball inside the pelvis that may be free
/// and within a limb's reach of ground, whatever the orientation. `resolution` is refined until
/// the ball is larger than a cell. `flights`: of all manoeuvres.
FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const std::function<bool()>& keep_going = {},
                           const std::vector<FlightBounds>& flights = {});

}  // namespace possibility::actions
