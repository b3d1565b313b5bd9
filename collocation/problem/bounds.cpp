#include "collocation/problem/bounds.h"

#include <fmt/format.h>

#include <cmath>

namespace possibility::collocation {

bool Contradict(const Bounds& bounds) {
  return std::isnan(bounds.lower) || std::isnan(bounds.upper) || bounds.lower > bounds.upper ||
         bounds.lower == kInfinity || bounds.upper == -kInfinity;
}

std::string Describe(const Bounds& bounds) {
  return fmt::format("[{}, {}]", bounds.lower, bounds.upper);
}

}  // namespace possibility::collocation
