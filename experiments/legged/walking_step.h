#pragma once

#include <map>
#include <memory>

#include "collocation/problem/optimal_control_problem.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Which joints of the robot move.
enum class StepJoints {
  kAll,
  kLegsAndSwingingArms  ///< of the arms, only the first two joints across the sagittal plane
};

struct WalkingStepSettings {
  double speed = 0.4;       ///< m/s
  double duration = 0.6;    ///< s, of one step
  double clearance = 0.04;  ///< m, of the swing foot's sole half-way
  StepJoints joints = StepJoints::kAll;
};

/// Joints of the arms, all but those of shoulder and elbow that swing in the sagittal plane, and
/// their positions in the gait's posture.
std::map<int, double> StillArmJoints(const models::RobotModel& robot, const models::Gait& gait);

/// One step of a humanoid in space, single support, periodic up to a mirror image, the swing foot
/// landing without speed. Minimises squares of torques and, less, of accelerations, forces and
/// distance from the posture of the robot's gait "walk", whose limbs must be its two soles.
std::unique_ptr<collocation::OptimalControlProblem> WalkingStep(
    const models::RobotModel& humanoid, const WalkingStepSettings& settings = {});

}  // namespace possibility::experiments
