#pragma once

#include <string>

#include "graph/action.h"

namespace possibility::graph {

enum class JobOutcome {
  kConfirmed,
  kRefuted,
  kFailed,     ///< the job threw, took too long or could not tell: nothing is known of its edge
  kCancelled,  ///< the job was ended because its answer was of no more use
};

/// What became of one confirmation job.
struct ConfirmationReport {
  int action = 0;  ///< whose job it was
  PointPair points;
  JobOutcome outcome = JobOutcome::kFailed;
  std::string reason;  ///< the job's own if refuted or undecided, what it threw if it threw
  double seconds = 0;  ///< time it ran, pauses left out
};

}  // namespace possibility::graph
