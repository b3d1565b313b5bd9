#pragma once

#include <Eigen/Core>

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Joints of the arms that hang near zero, clear of everything else. `joints`: num_joints, with the
/// legs where the robot stands. Of many samples the one that is nearest to zero, given that no link
/// of the arms comes within a clearance of others (6 % of the leg's length, less if none keeps it);
/// right arms mirror left ones. Returns all joints. Without arms: `joints`.
Eigen::VectorXd PostureWithArms(const RobotDraft& draft, const Eigen::VectorXd& joints);

}  // namespace possibility::actions
