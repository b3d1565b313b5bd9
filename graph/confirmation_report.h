#pragma once

#include <string>

#include "graph/action.h"

namespace possibility::graph {

enum class JobOutcome {
  kConfirmed,
  kRefuted,
  kFailed,  ///< the job threw: nothing is known of its edge
};

/// What became of one confirmation job.
struct ConfirmationReport {
  int action = 0;  ///< whose job it was
  PointPair points;
  JobOutcome outcome = JobOutcome::kFailed;
  std::string reason;  ///< the job's own if refuted, what it threw if failed
  double seconds = 0;  ///< spent in its slices
};

}  // namespace possibility::graph
