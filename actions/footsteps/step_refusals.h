#pragma once

#include <array>
#include <vector>

#include "actions/footsteps/footstep.h"

namespace possibility::actions {

/// What the robot could not do: a step that is at least as long, as high and as tilted in every
/// respect as one that failed is refused, too.
class StepRefusals {
 public:
  /// `other`: where the other limb bears.
  void Add(const Footstep& step, const Foothold& other) { refused_.push_back(Of(step, other)); }
  bool Refuses(const Footstep& step, const Foothold& other) const;

 private:
  /// Distances and heights of both ends of the step from the other limb, and the lift, m; tilts of
  /// the three footholds, rad.
  using Measures = std::array<double, 10>;
  static Measures Of(const Footstep& step, const Foothold& other);

  std::vector<Measures> refused_;
};

}  // namespace possibility::actions
