#pragma once

#include <cstddef>
#include <cstdint>

#include "actions/rollout/rollout_drift.h"
#include "actions/verify/plan_margins.h"
#include "actions/verify/verdict_table.h"

namespace possibility::actions {

/// What has been checked of a motion, and at which resolution.
struct MotionCoverage {
  std::int64_t samples = 0;
  double time = 0;      ///< s, between samples
  double position = 0;  ///< m, of bearing points off the line between samples
  double force = 0;     ///< N, or N m over 1 m, likewise

  void Add(const MotionCoverage& other) {
    samples += other.samples;
    time = std::max(time, other.time);
    position = std::max(position, other.position);
    force = std::max(force, other.force);
  }
};

/// Parts of plans that the verifier has accepted, for verification of plans that share them
/// (VerifierSettings::store): in the same world after a change, or on another route. Robots of one
/// content hash must be equal. Any thread may use it.
struct VerdictStore {
  /// `most_bytes`: of keys.
  explicit VerdictStore(std::size_t most_bytes = std::size_t{256} << 20)
      : motions(most_bytes / 2), rollouts(most_bytes / 4), margins(most_bytes / 4) {}

  VerdictTable<MotionCoverage> motions;  ///< runs of knots without a violation
  VerdictTable<RolloutDrift> rollouts;   ///< simulations that follow their motion
  VerdictTable<PlanMargins> margins;     ///< of phases; Margin::segment is 0 where it is measured
};

}  // namespace possibility::actions
