#pragma once

#include <memory>
#include <string>

#include "actions/conditions/manoeuvre.h"
#include "graph/confirmation_job.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Finds out whether an edge of a manoeuvre is possible where it is to happen: generates its
/// motion, then looks at the whole robot at most 5 ms apart, for obstacles and for itself. Tells
/// the manoeuvre (Record).
class MotionJob : public graph::ConfirmationJob {
 public:
  /// `manoeuvre` must outlive it. `checker`: of its robot and its environment.
  MotionJob(const Manoeuvre& manoeuvre, std::shared_ptr<const models::CollisionChecker> checker,
            graph::PointPair edge);

  graph::JobVerdict Run(graph::JobControl* control) override;
  std::string reason() const override { return reason_; }

 private:
  graph::JobVerdict Decide(const std::string& fault);

  const Manoeuvre& manoeuvre_;
  std::shared_ptr<const models::CollisionChecker> checker_;
  graph::PointPair edge_;
  std::string reason_;
};

}  // namespace possibility::actions
