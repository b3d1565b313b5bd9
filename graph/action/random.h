#pragma once

#include <cstdint>

#include "graph/action/exploration_space.h"

namespace possibility::graph {

/// Uniform integer in [0, count), the same on every platform (unlike the standard's distributions).
/// `count` >= 1.
std::uint64_t UniformIndex(std::uint64_t count, RandomGenerator* generator);

/// Uniform number in [low, high), the same on every platform.
double UniformReal(double low, double high, RandomGenerator* generator);

}  // namespace possibility::graph
