#pragma once

#include <functional>

#include "actions/plan/plan.h"

namespace possibility::experiments {

/// The robot's state at one instant, and its phase.
struct PlanSample {
  int segment = 0;
  const actions::Phase* phase = nullptr;  ///< of the sampled plan
  actions::Knot knot;
  bool is_knot = true;  ///< of the plan; otherwise interpolated between two
};

using VisitSample = std::function<void(const PlanSample&)>;

/// Visits every knot of every phase; two where phases meet, because tau and forces may jump.
void VisitKnots(const actions::Plan& plan, const VisitSample& visit);

/// Visits samples `period` s apart from the beginning, and the end. Where two phases meet: the
/// later one.
/// @throws InputError for more than 1e8 samples.
void VisitEvery(const actions::Plan& plan, double period, const VisitSample& visit);

}  // namespace possibility::experiments
