#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/jump/jump_library.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Guess in place of a table: distances that any legged robot has a fair chance of jumping, by leg
/// length alone and independent of height. One row per height (m, ascending).
JumpReach GuessReach(const JumpSolver& solver, const std::vector<double>& heights);

/// The rows of `guess` with the farthest distance found by solving; the shortest stays. The answers
/// stay in the library. Assumes that nothing beyond an impossible distance is possible.
/// @throws Cancelled.
JumpReach DeriveFarthest(const JumpReach& guess, JumpLibrary* library,
                         const CancellationToken& cancellation = {});

/// Follows from the longest flight and the largest root speed: JumpProblem bounds both, and
/// JumpMotion refuses faster motion.
FlightBounds BoundFlight(const JumpSettings& settings, const NaturalUnits& units);

}  // namespace possibility::actions
