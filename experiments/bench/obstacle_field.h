#pragma once

#include <cstdint>

#include "models/world/scenario.h"

namespace possibility::experiments {

/// A square of level ground with exactly `count` boxes and cylinders (besides the ground) in piles:
/// rubble and pillars, which walking and crawling both must avoid, and bars about a metre above the
/// ground, which allow crawling below but not walking. The square grows with `count` at constant
/// density. Start and goal are free, in opposite corners; ways between them are likely, not
/// certain. Robot and actions are left empty. The same arguments give the same field on every
/// machine.
/// @throws std::invalid_argument if `count` is negative.
models::Scenario ObstacleField(int count, std::uint64_t seed);

}  // namespace possibility::experiments
