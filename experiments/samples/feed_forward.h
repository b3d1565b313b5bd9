#pragma once

#include "actions/evidence/verifier_state.h"
#include "experiments/samples/plan_samples.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Joint torques and contact forces that realise a plan's motion between its knots exactly, as the
/// verifier computes them (docs/verification.md, "Forces between knots"): the forces interpolated
/// linearly plus the least change that balances the root, and the torques of inverse dynamics. One
/// per thread.
class FeedForward {
 public:
  /// `robot` must outlive it.
  explicit FeedForward(const models::RobotModel& robot) : robot_(robot), evaluator_(robot) {}

  /// Replaces tau and forces; at knots the plan's own stay. @throws InputError if a contact is not
  /// the robot's.
  void Complete(PlanSample* sample);

 private:
  const models::RobotModel& robot_;
  actions::StateEvaluator evaluator_;
};

}  // namespace possibility::experiments
