#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>

namespace possibility::actions {

/// Where the landing stances of a manoeuvre lie, seen from the frame of its launch stance.
struct LandingRange {
  Eigen::AlignedBox2d offset;  ///< m, x ahead and y to the left
  double turn = 0;             ///< rad, of the heading, at most, to either side
};

/// How far a manoeuvre takes the pelvis from the ground.
struct FlightBounds {
  double rise = 0;   ///< m, never higher than this above a place where a limb reaches ground
  double range = 0;  ///< m, never farther than this from such a place, seen from above
};

/// What a manoeuvre declares to the floods that prove a "no" (route_flood.h).
///
/// The rule: a bound may be too wide but never too narrow. It has to hold for every edge that the
/// manoeuvre could ever confirm (`landings`), or that any robot of this build could execute at all
/// (`flight`), wherever that is. A flood that trusts a bound which is too narrow calls a way closed
/// that is open: a false "no", the worst answer there is. Whoever is not sure declares nothing;
/// the planner then goes on searching to the time limit where it could have said "exhausted" (no
/// `landings`) or "proven_infeasible" (no `flight`).
struct ManoeuvreBounds {
  /// By how much higher (m) the ground of the landing is than that of the launch; nothing: the
  /// manoeuvre never leads there. Empty: not known.
  std::function<std::optional<LandingRange>(double rise)> landings;
  std::optional<FlightBounds> flight;  ///< nothing: not known
};

}  // namespace possibility::actions
