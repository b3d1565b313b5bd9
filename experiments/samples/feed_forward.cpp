#include "experiments/samples/feed_forward.h"

#include "actions/checks/forces_check.h"

namespace possibility::experiments {

void FeedForward::Complete(PlanSample* sample) {
  if (sample->is_knot) return;
  const actions::VerifierState state = evaluator_.Evaluate(sample->knot);
  actions::RealisedForces realised = actions::RealiseForces(
      state, actions::BearingPoints(robot_, *sample->phase), robot_, evaluator_.dynamics());
  sample->knot.tau = std::move(realised.torques);
  sample->knot.forces = std::move(realised.forces);
}

}  // namespace possibility::experiments
