#pragma once

#include <limits>
#include <string>

namespace possibility::collocation {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Bounds {
  double lower = -kInfinity;
  double upper = kInfinity;
};

/// Whether no number lies within the bounds.
bool Contradict(const Bounds& bounds);

/// For messages: "[0, 2]".
std::string Describe(const Bounds& bounds);

}  // namespace possibility::collocation
