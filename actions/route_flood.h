#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actions/block_flood.h"
#include "actions/locomotion_model.h"
#include "actions/manoeuvre_bounds.h"
#include "actions/plan.h"
#include "actions/quasi_static_action.h"
#include "actions/stance_cells.h"

namespace possibility::actions {

struct FloodResult {
  /// False is a proof at any resolution: every cell errs towards open, so no continuous path
  /// crosses a closed barrier of cells. True only says that this resolution finds no barrier.
  bool route_may_exist = true;
  /// Whether the flood came to its limits: then it says nothing.
  bool is_cut_short = false;
  /// If there is none: what the flood filled, and what closes the cells just beyond the closest.
  Barrier barrier;
  /// If one may exist, of the flood over C_S: the middles of the blocks of cells it leads through.
  std::vector<GroundedStance> way;
  std::int64_t cells = 0;  ///< blocks of cells tested
};

/// What a manoeuvre adds to the flood over C_S: which landing stances a launch stance leads to
/// (ManoeuvreBounds::landings, which must be there).
struct FloodManoeuvre {
  int from = 0;  ///< gaits
  int to = 0;
  std::function<std::optional<LandingRange>(double rise)> landings;
  std::string name = {};  ///< for messages
};

/// Flood over what can be confirmed: cells of (gait, x, y, heading) in which C_S may hold
/// somewhere, with shapes shrunk by the size of a cell, joined through transitions and manoeuvres.
/// Without manoeuvres nobody leaves the height of the start. More halvings or smaller cells take
/// more time, and narrower passages for closed.
FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            const StanceCellSettings& settings, const FloodLimits& limits = {},
                            const std::vector<FloodManoeuvre>& manoeuvres = {});

/// Flood over C_N: cells of the position of the largest ball inside the pelvis that may be free
/// and within a limb's reach of ground, whatever the orientation. `resolution` is refined until
/// the ball is larger than a cell. `flights`: of all manoeuvres.
FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const FloodLimits& limits = {},
                           const std::vector<FlightBounds>& flights = {});

}  // namespace possibility::actions
