#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Quantities of a phase in a file of version 2 (docs/file_formats.md), in the order in which they
/// are stored.
enum PackedQuantity { kTimes, kAccelerations, kRates, kPositions, kTorques, kForces };
inline constexpr std::size_t kNumPackedQuantities = 6;

/// Whether a file of version 2 holds torques.
enum class PackedTorques { kStored, kLeftOut };

/// What a phase's integers cannot tell.
struct PackedOutline {
  /// The first knot's t, q and v; none: those of the last knot of the phase before.
  struct Start {
    double t = 0;       ///< s
    Eigen::VectorXd q;  ///< 7 + joints
    Eigen::VectorXd v;  ///< 6 + joints
  };

  Eigen::Index num_knots = 0;
  Eigen::Index num_joints = 0;
  Eigen::Index num_points = 0;  ///< columns of forces
  bool has_torques = true;      ///< false: they are left out
  int force_bits = 0;
  int acceleration_bits = 0;  ///< accelerations are multiples of 2^-this
  int rate_bits = 0;          ///< likewise, what predictions of rates are off
  int position_bits = 0;      ///< likewise, of positions
  std::optional<Start> start;

  /// The numbers of integers of a quantity.
  std::size_t CountOf(PackedQuantity quantity) const;
};

inline constexpr int kMostPackedBits = 46;
inline constexpr int kFewestPackedBits = -20;
/// Torques are coarser than forces: no sum of torques must vanish.
inline constexpr int kTorqueBitsFewer = 2;

/// The motion of a phase as integers: for each component of a quantity, one per knot or per
/// interval.
struct PackedPhase {
  PackedOutline outline;
  std::array<std::vector<std::int64_t>, kNumPackedQuantities> numbers;
};

/// `before`: the phase before, of which the last two knots are needed, as Unpack gives them; null:
/// none. A phase that begins where it ends needs no start. A phase without torques (all tau empty)
/// stays without.
/// @throws std::invalid_argument if a number is not finite or too large, sizes differ, there are
/// fewer than two knots, times do not increase, or a quaternion is no unit one.
PackedPhase Pack(const Phase& phase, int force_bits, const Phase* before,
                 PackedTorques torques = PackedTorques::kStored);

/// The knots; tau is empty if torques are left out. `numbers` as CountOf says. `before`: the last
/// knot of the phase before, needed without a start. Values may be infinite, times may not
/// increase: the caller checks.
std::vector<Knot> Unpack(const PackedPhase& packed, const Knot* before);

/// Rounds a phase to what a file of version 2 holds: the phase that Pack and Unpack give.
/// `before`: the rounded phase before; null: none. @throws std::invalid_argument as Pack does.
void RoundToPackedSteps(int force_bits, const Phase* before, Phase* phase);

}  // namespace possibility::actions
