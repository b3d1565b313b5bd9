#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/flood/block_flood.h"
#include "actions/flood/stance_cells.h"
#include "actions/plan/plan.h"

namespace possibility::actions {

struct FloodResult {
  /// False is a proof at any resolution: cells are optimistic, so no continuous path crosses a
  /// closed barrier of cells. True only means that this resolution finds no barrier.
  bool route_may_exist = true;
  /// The flood reached its limits: no result.
  bool is_cut_short = false;
  /// If no route exists: the region filled, and what closes the cells next to the closest one.
  Barrier barrier;
  /// If a route may exist, from the flood over C_S: the middles of the blocks along it.
  std::vector<GroundedStance> way;
  std::int64_t cells = 0;  ///< blocks of cells tested
};

/// A manoeuvre in the flood over C_S: the landing stances of each launch stance
/// (ManoeuvreBounds::landings, which must not be empty).
struct FloodManoeuvre {
  int from = 0;  ///< gaits
  int to = 0;
  std::function<std::optional<LandingRange>(double rise)> landings;
  std::string name = {};  ///< for messages
};

}  // namespace possibility::actions
