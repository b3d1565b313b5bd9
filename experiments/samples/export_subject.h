#pragma once

#include <optional>

#include "actions/plan/plan.h"
#include "experiments/samples/plan_samples.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// A plan with motion that fits its robot's sizes, to be exported.
struct ExportSubject {
  const actions::Plan& plan;
  const models::RobotModel& robot;
  const models::Scenario& scenario;
};

/// Which instants are exported, and what.
struct ExportSampling {
  std::optional<double> period;  ///< s; none: the plan's knots
  bool margins = false;
  bool torques = false;  ///< also in a plan.zip, if they follow from the rest
};

/// Visits the plan's knots, or samples a period apart with exact feed-forward (FeedForward).
/// @throws InputError for more than 1e8 samples.
void VisitSamples(const ExportSubject& subject, const ExportSampling& sampling,
                  const VisitSample& visit);

}  // namespace possibility::experiments
