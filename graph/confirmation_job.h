#pragma once

#include <string>

#include "graph/job_control.h"

namespace possibility::graph {

enum class JobVerdict {
  kConfirmed,  ///< the edge is possible
  kRefuted,    ///< the edge is impossible
  kUndecided,  ///< the job could not tell, or was cancelled
};

/// A routine that examines one edge (paper: SpawnConfirmationJob).
///
/// A job runs on a thread of its own, in one call from its beginning to its end, and asks its
/// JobControl for leave to go on. Nobody needs to cut an optimisation into slices that return: a
/// paused job keeps its stack, the queue decides who runs, and a routine that knows how to be
/// paused and cancelled from another thread (RunSteered) needs no call-back into the job at all.
class ConfirmationJob {
 public:
  virtual ~ConfirmationJob() = default;

  /// Returns within 50 ms after `control` is cancelled; its verdict then counts for nothing. May
  /// throw: that refutes nothing, the edge is set aside. Runs beside other jobs and beside
  /// exploration, so what it shares with them must be immutable or guarded.
  virtual JobVerdict Run(JobControl* control) = 0;

  /// Why the job was refuted or could not tell, for people; asked after Run, on the same thread.
  virtual std::string reason() const { return {}; }
};

}  // namespace possibility::graph
