#pragma once

#include <Eigen/Core>
#include <vector>

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Pairs of links that are not to be tested, besides parent and child: those whose shapes overlap
/// in the posture `joints`, where the robot stands; and those around two joints with a small link
/// between, or three at one place, whose shapes come within a centimetre of each other in some
/// sample of postures near it. Their joint limits keep the real parts apart, which are smaller than
/// their hulls. The reason says which, and that samples are no proof.
std::vector<IgnoredPair> TouchingPairs(const RobotDraft& draft, const Eigen::VectorXd& joints);

}  // namespace possibility::actions
