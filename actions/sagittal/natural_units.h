#pragma once

#include <cmath>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

/// A robot's own units: its weight, the length of its leg, and what gravity makes of them. Limits
/// and guesses of dynamic actions are multiples of them, so that they fit robots of any size
/// (dynamic similarity; Alexander 1989).
struct NaturalUnits {
  double force = 0;   ///< the weight, N
  double length = 0;  ///< of the stretched leg, m

  double time() const { return std::sqrt(length / dynamics::kGravity); }   ///< s
  double speed() const { return std::sqrt(length * dynamics::kGravity); }  ///< m/s
  double impulse() const { return force * time(); }                        ///< N s
};

}  // namespace possibility::actions
