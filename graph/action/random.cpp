#include "graph/action/random.h"

#include <limits>

namespace possibility::graph {

std::uint64_t UniformIndex(std::uint64_t count, RandomGenerator* generator) {
  // Numbers beyond the last whole multiple of `count` would favour small indices.
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t limit = kMax - kMax % count;
  std::uint64_t number = (*generator)();
  while (number >= limit) {
    number = (*generator)();
  }
  return number % count;
}

double UniformReal(double low, double high, RandomGenerator* generator) {
  const double unit = static_cast<double>((*generator)() >> 11) * 0x1.0p-53;
  return low + unit * (high - low);
}

}  // namespace possibility::graph
