#pragma once

#include <memory>
#include <string>

#include "actions/conditions/manoeuvre.h"
#include "graph/action/confirmation_job.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Decides whether an edge of a manoeuvre is possible in its world: generates the motion, then
/// checks the whole robot, at samples at most 5 ms apart, for collisions with obstacles and with
/// itself.
class MotionJob : public graph::ConfirmationJob {
 public:
  /// `manoeuvre` must outlive the job. `checker`: for the manoeuvre's robot and environment.
  MotionJob(const Manoeuvre& manoeuvre, std::shared_ptr<const models::CollisionChecker> checker,
            graph::Edge edge);

  graph::JobVerdict Run(graph::JobControl* control) override;
  double work_of_checkpoint() const override { return 0.1e-3; }
  bool bounds_its_effort() const override { return manoeuvre_.BoundsItsEffort(); }
  std::string reason() const override { return reason_; }

 private:
  graph::JobVerdict Decide(const std::string& fault);

  const Manoeuvre& manoeuvre_;
  std::shared_ptr<const models::CollisionChecker> checker_;
  graph::Edge edge_;
  std::string reason_;
};

}  // namespace possibility::actions
