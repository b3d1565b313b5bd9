#pragma once

#include <cstdint>

#include "models/world/scenario.h"

namespace possibility::experiments {

/// A square of level ground, strewn with exactly `count` boxes and cylinders (the ground apart) in
/// piles: rubble that lies on the ground and pillars that stand on it, which walking and crawling
/// go around alike, and bars about a metre above it that one can crawl below but not walk. The
/// square grows with `count`, so that it is always as crowded. Start and goal are free, in opposite
/// corners; that ways lead from one to the other is likely, not certain. Robot and actions are left
/// empty. The same arguments give the same field on every machine.
/// @throws std::invalid_argument if `count` is negative.
models::Scenario ObstacleField(int count, std::uint64_t seed);

}  // namespace possibility::experiments
