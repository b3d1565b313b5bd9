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

}  // namespace possibility::actions
