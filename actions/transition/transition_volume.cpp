#include "actions/transition/transition_volume.h"

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

SweptVolume SweepTransition(const models::RobotModel& robot, const TransitionMotion& transition) {
  SweptVolume volume;
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : transition.phases()) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      volume.Add(robot, kinematics.X_WL(), {PlanarPose()}, {});
    }
  }
  return volume;
}

}  // namespace possibility::actions
