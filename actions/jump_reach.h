#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "actions/jump_library.h"
#include "actions/manoeuvre_bounds.h"

namespace possibility::actions {

/// Distances that any legged body has a fair chance of jumping, for lack of a table: by leg length
/// alone, whatever the height. One row per height (m, ascending).
JumpReach GuessReach(const JumpSolver& solver, const std::vector<double>& heights);

/// The same rows with the farthest distance found out by solving; the shortest stays. What is
/// solved on the way stays in the library. Takes for granted that nothing beyond an impossible
/// distance is possible. `keep_going`: asked often, may be empty.
/// @throws Abandoned if it says no.
JumpReach DeriveFarthest(const JumpReach& guess, JumpLibrary* library,
                         const std::function<bool()>& keep_going = {});

/// No faster (m/s) does a leg throw up the root while its foot stands: all joints turn at their
/// limits at once, each at a lever as long as the links between it and the root. Infinite if one of
/// them has no limit. How fast a foot may turn over its toes meanwhile is not counted.
double HighestLaunchSpeed(const JumpModel& model);

/// By joint speeds and lengths alone, of how a body that legs throw up can fly; nothing if a joint
/// has no limit.
std::optional<FlightBounds> BoundFlight(const JumpModel& model);

}  // namespace possibility::actions
