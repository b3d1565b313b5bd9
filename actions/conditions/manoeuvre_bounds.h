#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>

namespace possibility::actions {

/// Region of a manoeuvre's landing stances, in the frame of its launch stance.
struct LandingRange {
  Eigen::AlignedBox2d offset;  ///< m, x ahead and y to the left
  double turn = 0;             ///< rad, largest change of heading to either side
};

/// How far the pelvis gets from the ground during a manoeuvre.
struct FlightBounds {
  double rise = 0;   ///< m, largest height above a place where a limb reaches ground
  double range = 0;  ///< m, largest horizontal distance from such a place
};

/// Bounds that a manoeuvre declares to the floods that prove a "no" (route_flood.h).
///
/// Rule: a bound may be too wide but never too narrow. `landings` must hold for every edge that the
/// manoeuvre could ever confirm, in any scene; `flight` for every edge that any robot of this build
/// could execute at all. A bound that is too narrow makes a flood call an open way closed: a false
/// "no", the worst possible answer. If in doubt, declare nothing. The planner then searches to the
/// time limit where it could have answered "exhausted" (no `landings`) or "proven_infeasible" (no
/// `flight`).
struct ManoeuvreBounds {
  /// Landing range by `rise`, the height (m) of the landing ground above the launch ground. Returns
  /// none if the manoeuvre never rises by that much. Empty function: not known.
  std::function<std::optional<LandingRange>(double rise)> landings;
  std::optional<FlightBounds> flight;  ///< none: not known
};

}  // namespace possibility::actions
