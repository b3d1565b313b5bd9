#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/footholds/foothold_cells.h"
#include "actions/footholds/footstep.h"
#include "actions/footholds/standing_room.h"

namespace possibility::actions {

/// Headings square to the sides of boxes and surfaces: of corridors, doors and edges, rad.
std::vector<double> SquareHeadingsOf(const models::Environment& environment);

/// What searches for steps of a gait know of a world, wherever they begin and end. Several threads
/// may use it.
struct StepGround {
  /// References must outlive this.
  StepGround(const LocomotionModel& model, int gait, const World& world,
             const FootstepLimits& limits);
  StepGround(const StepGround&) = delete;
  StepGround& operator=(const StepGround&) = delete;

  /// Patches keep this far from each other, m.
  static constexpr double kPatchGap = 0.015;

  double first_heading() const { return headings.empty() ? 0 : headings.front(); }  ///< rad

  std::vector<double> headings;  ///< SquareHeadingsOf
  // Of gaits on two soles.
  std::optional<FootholdCells> cells;
  std::optional<StandingRoom> room;
};

}  // namespace possibility::actions
