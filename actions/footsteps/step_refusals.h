#pragma once

#include <array>
#include <vector>

#include "actions/footholds/footstep.h"

namespace possibility::actions {

/// What the robot could not do, and what is refused because of that.
class StepRefusals {
 public:
  enum class Breadth {
    kBeyond,  ///< all that is at least as long, as high and as tilted in every respect
    kSame,    ///< only what is nearly the same: rules out less, and leaves more to try
  };
  explicit StepRefusals(Breadth breadth) : breadth_(breadth) {}

  /// A step as a whole. `other`: where the other limbs bear (RestOf).
  void Add(const Footstep& step, const Foothold& other) { steps_.push_back(Of(step, other)); }
  /// A posture in which one limb is about to leave its place or has just reached it while the other
  /// one bears, whatever the rest of the step.
  void AddEnd(const Foothold& place, const Foothold& other) { ends_.push_back(Of(place, other)); }
  bool Refuses(const Footstep& step, const Foothold& other) const;

 private:
  /// Distances and heights of both ends of the step from the other limb, and the lift, m; tilts of
  /// the three footholds, rad.
  using StepMeasures = std::array<double, 10>;
  /// Ahead, behind, aside, up and down from the other limb, m; turn away from it and towards it,
  /// and tilts of both footholds, rad.
  using EndMeasures = std::array<double, 9>;
  static StepMeasures Of(const Footstep& step, const Foothold& other);
  static EndMeasures Of(const Foothold& place, const Foothold& other);

  Breadth breadth_;
  std::vector<StepMeasures> steps_;
  std::vector<EndMeasures> ends_;
};

}  // namespace possibility::actions
