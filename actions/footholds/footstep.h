#pragma once

#include <cmath>
#include <vector>

#include "actions/footholds/foothold_ground.h"

namespace possibility::actions {

/// One limb moves to its next place.
struct Footstep {
  int limb = 0;
  Foothold from;
  Foothold to;
  double lift = 0;  ///< m, of the swing (SwingPath)

  /// Up or down to another level or slope, m.
  double ChangeOfHeight() const { return AreOnOneSlope(from, to) ? 0 : std::abs(to.z - from.z); }
};

/// Whether a gait has two limbs, both of which hold their orientation.
bool StandsOnTwoSoles(const models::Gait& gait);

/// Of all limbs' stances.
PlanarPose MeanStance(const std::vector<Foothold>& feet);

/// What the other limbs stand in while `limb` swings: the other one's place, or the mean of
/// several, as if level.
Foothold RestOf(const std::vector<Foothold>& feet, int limb);

/// The family of steps that a search chooses from. Of two limbs: one as the other sees it; of more:
/// one in the mean stance of the others.
struct FootstepLimits {
  double forward = 0.34;    ///< m: stance of one limb ahead of the others'
  double lateral = 0.16;    ///< m: aside; of two limbs outwards
  double turn = 0.35;       ///< rad
  double rise = 0.16;       ///< m, up or down
  double lift = 0.27;       ///< m
  double margin = 0.01;     ///< m, of bearing points from the edge of their ground
  double clearance = 0.03;  ///< m, of swings
  double lowest_root = 0;   ///< m, above the ground of the limb that bears alone
  double usual_root = 0;    ///< m, likewise: searched with first, if higher
  double trunk_margin = 0;  ///< m, of the trunk from obstacles, seen from above

  /// Shares of the robot's size.
  static FootstepLimits Of(const models::RobotModel& robot, const NominalStance& stance);
};

/// Expected duration of a step, s.
double ExpectedDuration(const Footstep& step);
/// Of one on level ground, s.
inline constexpr double kLevelStep = 0.65;

}  // namespace possibility::actions
