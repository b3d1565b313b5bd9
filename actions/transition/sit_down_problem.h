#pragma once

#include "actions/sagittal/sagittal_problem.h"

namespace possibility::actions {

struct SitDownSettings : SagittalSettings {
  collocation::Bounds sit = {0.5, 1.5};   ///< s, on the feet alone
  collocation::Bounds bear = {0.3, 1.0};  ///< s, on feet and hands
};

/// Hash of what solved transitions depend on (motion_identity.h).
std::string SitDownIdentity(const models::RobotModel& robot, const SitDownSettings& settings = {});

/// From the launch stance to the landing stance without a jump: the feet stay, the robot sits
/// down, sets its hands down at no speed and moves on until it rests. Backwards in time it stands
/// up.
class SitDownProblem : public SagittalProblem {
 public:
  enum PhaseIndex { kSit, kBear, kNumPhases };

  /// Where the landing stance's frame must be for the feet to stay, m ahead of the launch's.
  static double Displacement(const SagittalModel& model);

  /// `model` must outlive the problem.
  SitDownProblem(const SagittalModel& model, const SitDownSettings& settings);
};

}  // namespace possibility::actions
