#pragma once

#include <optional>
#include <vector>

#include "dynamics/contact/contact_patches.h"
#include "dynamics/forward/forward_dynamics.h"

namespace possibility::dynamics {

/// m: a free point that is at most this high cannot be told from one on its plane. It comes down
/// when it has sunk by this. A fall from there ends below RobotRolloutSettings::rest_speed.
inline constexpr double kContactSlack = 1e-8;

/// The constants of a rollout while the same points are held. Indices are of contacts
/// (RolloutContact).
struct RolloutStance {
  std::vector<int> held;                     ///< ascending
  std::vector<int> jammed;                   ///< subset of `held` that friction jams
  std::vector<HeldPoint> points;             ///< in the order of `held`
  std::vector<ContactPatchBalance> patches;  ///< of the held points; indices into `points`
  std::vector<int> free;                     ///< the other contacts
  bool has_landed = false;                   ///< some contact has been held so far
  /// By contact, m: usually 0. For a free contact so near to its plane that rounding decides its
  /// side, the depth below the plane at which it comes down unless it has been above the plane by
  /// as much.
  std::vector<double> slack;
  /// By contact: whether it passes through its plane, beside the ground, if it is below it.
  std::vector<bool> passes;
  std::optional<double> calm_since;  ///< s: time since which the kinetic energy is below the bound
};

}  // namespace possibility::dynamics
