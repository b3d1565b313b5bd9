#pragma once

#include <optional>
#include <vector>

#include "dynamics/contact/contact_patches.h"
#include "dynamics/forward/forward_dynamics.h"

namespace possibility::dynamics {

/// m: a free point that is not higher than this cannot be told from one on its plane; it comes down
/// when it has sunk by this. A fall from there ends below RobotRolloutSettings::rest_speed.
inline constexpr double kContactSlack = 1e-8;

/// What is constant in a rollout of a robot while the same points are held. Indices are of contacts
/// (RolloutContact).
struct RolloutStance {
  std::vector<int> held;                     ///< ascending
  std::vector<int> jammed;                   ///< those of them that friction jams
  std::vector<HeldPoint> points;             ///< by `held`
  std::vector<ContactPatchBalance> patches;  ///< of those; indices into `points`
  std::vector<int> free;                     ///< the other contacts
  bool has_landed = false;                   ///< some contact has been held by now
  /// By contact, m: 0, or, for a free one so near to its plane that rounding decides on which side
  /// it is, how far below the plane it comes down, until it has been above by kContactSlack.
  std::vector<double> slack;
  std::optional<double> calm_since;  ///< s: kinetic energy below the bound since
};

}  // namespace possibility::dynamics
