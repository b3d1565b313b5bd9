#pragma once

#include <vector>

#include "actions/motion_builder.h"
#include "actions/nominal_stance.h"
#include "actions/planar_pose.h"
#include "models/robot_model.h"

namespace possibility::actions {

/// A scripted quasi-static transition from one gait's nominal stance to another's. The patches
/// that both gaits use stay where they are; the others touch down where the second gait wants
/// them.
class TransitionMotion {
 public:
  /// @throws InputError if the two stances do not agree about the shared patches, or a keyframe
  ///   cannot be reached.
  TransitionMotion(const models::RobotModel& robot, const models::Transition& transition,
                   const NominalStance& from, const NominalStance& to);

  const NominalStance& from() const { return *from_; }
  const NominalStance& to() const { return *to_; }

  /// Stance frame of the second gait in the frame of the first.
  const PlanarPose& displacement() const { return displacement_; }

  /// Forward motion from rest at `stance`; the backward one is its Reversed().
  std::vector<MotionPhase> Phases(const PlanarPose& stance, double z, double time_scale) const;

  double ExpectedDuration() const;  ///< s

 private:
  /// The robot at rest at one keyframe, in the first gait's stance frame.
  struct Stop {
    double duration = 0;
    std::vector<int> contacts;  ///< that bear during the motion that ends here
    double root_height = 0;
    double root_pitch = 0;
    Eigen::Vector2d centre_of_mass = Eigen::Vector2d::Zero();
    Eigen::VectorXd joints;
  };

  void AlignStances();
  void SolveStops(const models::Transition& transition);
  LimbTask BearingLimb(int contact, const PlanarPose& stance, double z) const;

  const models::RobotModel* robot_;
  const NominalStance* from_;
  const NominalStance* to_;
  PlanarPose displacement_;
  std::vector<Stop> stops_;  ///< the first is the nominal stance of `from`
};

}  // namespace possibility::actions
