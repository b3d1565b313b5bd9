#pragma once

#include <vector>

#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "models/robot/contact_schedule.h"

namespace possibility::actions {

/// Greatest displacement between the stances of two groups of limbs, in each direction alone. Of
/// one in several directions the CombinedEffort of the three shares is at most 1.
struct StepBounds {
  double forward = 0;  ///< m
  double lateral = 0;  ///< m
  double turn = 0;     ///< rad
};

/// What a displacement asks for whose three parts alone ask for so much: the norm with
/// exponent 1.5. The sum would forbid most of what limbs can do; with the root of squares many
/// steps have to be slowed down (docs/gaits.md, "Bends").
double CombinedEffort(double ahead, double aside, double turn);

/// Durations of a dynamic gait's intervals, s.
struct StepTiming {
  double swing = 0;           ///< of a group of limbs over `swing_length`; shorter swings take less
  double swing_length = 0;    ///< m
  double double_support = 0;  ///< between swings
  double start = 0;           ///< before the first swing, and after the last one
};

/// Duration of a swing over `length` (m), s.
double SwingTime(const StepTiming& timing, double length);

/// Groups of limbs that swing together, in turn. Of two limbs each is a group. Four limbs form two
/// pairs: those whose supports, each on its own, hold the nominal centre of mass best. Otherwise,
/// and where a pair bears on a line (point feet), every limb is a group.
std::vector<std::vector<int>> SwingGroups(const NominalStance& stance);

/// One swing: the group of limbs, and the stance that they reach.
struct Step {
  int group = 0;
  PlanarPose stance;
  double slowness = 1;  ///< multiplies the swing's duration
};

/// Steps along a way from all limbs in its first stance to all limbs in its last one. The ways of
/// the groups alternate wherever they can; where feet would come too close to each other, one group
/// closes up to the other. As few steps as the bounds allow, and as equal as that number allows.
/// `way`: at least one stance; straight lines in between. `shares`: of the bounds aside and in
/// turns on each of these lines; none: 1. Empty if it leads nowhere.
std::vector<Step> PlanSteps(const NominalStance& stance,
                            const std::vector<std::vector<int>>& groups,
                            const std::vector<PlanarPose>& way, const StepBounds& bounds,
                            const std::vector<double>& shares = {});

/// The schedule of the steps on ground of height 0, from rest in `start`.
models::ContactSchedule ScheduleOf(const models::RobotModel& robot, const NominalStance& stance,
                                   const std::vector<std::vector<int>>& groups,
                                   const PlanarPose& start, const std::vector<Step>& steps,
                                   const StepTiming& timing);

}  // namespace possibility::actions
