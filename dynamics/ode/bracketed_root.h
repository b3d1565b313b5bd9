#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace possibility::dynamics {

/// Where a scalar function has a value.
struct RootPoint {
  double at = 0;
  double value = 0;
};

/// A root between two points whose values differ in sign: the end on the side of `after` of an
/// interval of at most `resolution` (> 0) that holds it, or an exact zero. Inverse quadratic
/// interpolation where it can be trusted, bisection elsewhere (Chandrupatla 1997).
template <typename Function>
double BracketedRoot(RootPoint before, RootPoint after, double resolution, Function&& function) {
  RootPoint newest = before, opposite = after, replaced = before;
  double share = before.value / (before.value - after.value);
  for (bool is_first = true; newest.value != 0 && opposite.value != 0; is_first = false) {
    const double width = opposite.at - newest.at;
    if (std::abs(width) <= resolution) break;
    if (!is_first) {
      share = 0.5;
      const double x = (newest.at - opposite.at) / (replaced.at - opposite.at);
      const double y = (newest.value - opposite.value) / (replaced.value - opposite.value);
      if (y * y < x && (1 - y) * (1 - y) < 1 - x) {
        share = newest.value / (opposite.value - newest.value) * replaced.value /
                    (opposite.value - replaced.value) +
                (replaced.at - newest.at) / width * newest.value / (replaced.value - newest.value) *
                    opposite.value / (replaced.value - opposite.value);
      }
    }
    const double least = resolution / 2 / std::abs(width);
    const double at = newest.at + std::clamp(share, least, 1 - least) * width;
    if (at == newest.at || at == opposite.at) break;
    const RootPoint point{at, function(at)};
    replaced = newest;
    if (point.value * newest.value < 0) {
      replaced = std::exchange(opposite, newest);
    }
    newest = point;
  }
  const bool is_beyond = newest.value == 0 || newest.value * before.value < 0;
  return is_beyond ? newest.at : opposite.at;
}

}  // namespace possibility::dynamics
