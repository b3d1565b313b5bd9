#pragma once

#include <optional>
#include <string>

namespace possibility::actions {

/// Deviation of a simulation from its reference motion.
struct RolloutDrift {
  double start = 0;              ///< s, of the motion
  double end = 0;                ///< s, likewise
  double worst_position = 0;     ///< m, of the root, during the motion
  double worst_orientation = 0;  ///< rad, likewise
  double worst_joint = 0;        ///< rad or m, likewise
  double end_position = 0;       ///< m, of the root, once settled
  double end_orientation = 0;    ///< rad, likewise
  double end_speed = 0;          ///< m/s or rad/s, the root's greater one, likewise
  bool ends_at_rest = false;     ///< the motion does, so the simulation must
  int impacts = 0;               ///< instants with impacts; 0 on compliant ground
  double torque_used = 0;        ///< greatest |torque| over effort limit; 0 if not asked for
  double slide = 0;              ///< m: farthest that a bearing point slides; on compliant ground
  /// Time of the motion, s, when the root first departs by kFallOrientation or kFallHeight.
  std::optional<double> fell_at;
  std::string failure;  ///< one line: why no end state exists; empty if it does

  /// Whether the simulation reaches its end and the robot does not fall.
  bool survives() const { return failure.empty() && !fell_at; }
  /// Whether the robot ends near the motion's end, and at rest if the motion does.
  bool follows() const;
};

/// Bounds of RolloutDrift::follows.
inline constexpr double kRolloutPosition = 0.05;    // m
inline constexpr double kRolloutOrientation = 0.1;  // rad
inline constexpr double kRolloutSpeed = 0.05;       // m/s and rad/s
/// Bounds of RolloutDrift::fell_at.
inline constexpr double kFallOrientation = 0.5;  // rad
inline constexpr double kFallHeight = 0.2;       // m

inline bool RolloutDrift::follows() const {
  return failure.empty() && end_position <= kRolloutPosition &&
         end_orientation <= kRolloutOrientation && (!ends_at_rest || end_speed <= kRolloutSpeed);
}

}  // namespace possibility::actions
