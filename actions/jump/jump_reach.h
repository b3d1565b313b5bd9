#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/jump/jump_library.h"

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

/// By how long a jump may fly and how fast its root may move meanwhile: JumpProblem bounds both,
/// and JumpMotion refuses what is faster.
FlightBounds BoundFlight(const JumpSettings& settings);

}  // namespace possibility::actions
