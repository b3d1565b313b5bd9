#pragma once

#include "actions/sagittal/sagittal_problem.h"

namespace possibility::actions {

struct SitDownSettings : SagittalSettings {
  // Durations, times sqrt(l / g) (NaturalUnits).
  collocation::Bounds sit = {2, 5.5};     ///< on the feet alone
  collocation::Bounds bear = {1.2, 3.9};  ///< on feet and hands
};

/// Hash of what solved transitions depend on (motion_identity.h).
std::string SitDownIdentity(const models::RobotModel& robot, const SitDownSettings& settings = {});

/// Motion from the launch stance to the landing stance without a jump: the feet stay, the robot
/// sits down, sets its hands down at zero speed and moves on until it rests. Reversed in time, the
/// robot stands up.
class SitDownProblem : public SagittalProblem {
 public:
  enum PhaseIndex { kSit, kBear, kNumPhases };

  /// Position of the landing stance's frame for which the feet stay, m ahead of the launch
  /// stance's.
  static double Displacement(const SagittalModel& model);

  /// `model` must outlive the problem.
  SitDownProblem(const SagittalModel& model, const SitDownSettings& settings);
};

}  // namespace possibility::actions
