#pragma once

#include <string>

#include "graph/action/action.h"

namespace possibility::graph {

enum class JobOutcome {
  kConfirmed,
  kRefuted,
  kFailed,     ///< the job threw, took too long or could not tell: the edge stays undecided
  kCancelled,  ///< the job was ended because its answer was no longer needed
};

/// The outcome of one confirmation job.
struct ConfirmationReport {
  int action = 0;  ///< the action that spawned the job
  Edge points;
  JobOutcome outcome = JobOutcome::kFailed;
  std::string reason;  ///< the job's own if refuted or undecided; the exception's text if it threw
  double seconds = 0;  ///< running time, without pauses
};

}  // namespace possibility::graph
