#pragma once

#include "actions/verify/plan_margins.h"
#include "experiments/samples/export_subject.h"
#include "models/world/ground_map.h"

namespace possibility::experiments {

/// The margins of samples of a plan, which must outlive it.
class SampleMargins {
 public:
  explicit SampleMargins(const ExportSubject& subject)
      : ground_(subject.scenario.environment),
        margins_(subject.robot, subject.scenario.environment, ground_) {}
  SampleMargins(const SampleMargins&) = delete;
  SampleMargins& operator=(const SampleMargins&) = delete;

  actions::PlanMargins Of(const PlanSample& sample) {
    return margins_.At(sample.segment, *sample.phase, sample.knot);
  }

 private:
  models::GroundMap ground_;
  actions::InstantMargins margins_;
};

}  // namespace possibility::experiments
