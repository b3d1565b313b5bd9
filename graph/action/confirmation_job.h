#pragma once

#include <string>

#include "graph/action/job_control.h"

namespace possibility::graph {

enum class JobVerdict {
  kConfirmed,  ///< the edge is possible
  kRefuted,    ///< the edge is impossible
  kUndecided,  ///< the job could not tell, or was cancelled
};

/// A routine that examines one edge (paper: SpawnConfirmationJob).
///
/// A job runs on its own thread, in one call from beginning to end, and asks its JobControl whether
/// it may go on. An optimisation need not be cut into slices that return: a paused job keeps its
/// stack, and the queue decides which job runs. A routine that can be paused and cancelled from
/// another thread (RunSteered) needs no call-back into the job at all.
class ConfirmationJob {
 public:
  virtual ~ConfirmationJob() = default;

  /// Returns within 50 ms after `control` is cancelled; its verdict is then ignored. May throw: the
  /// edge is then set aside, not refuted. Runs concurrently with other jobs and with exploration,
  /// so shared data must be immutable or guarded.
  virtual JobVerdict Run(JobControl* control) = 0;

  /// Declared mean work between two checkpoints, s. A queue without workers measures turns by it,
  /// so a job that asks often is not paused too early.
  virtual double work_of_checkpoint() const { return kWorkOfCheckpoint; }
  static constexpr double kWorkOfCheckpoint = 3e-3;  ///< s

  /// Whether the job bounds its effort itself, in work and not in time. No time limit of its own
  /// ends it then, so its verdict does not depend on how busy the machine is.
  virtual bool bounds_its_effort() const { return false; }

  /// Why the job refuted the edge or could not tell, for reports. Called after Run, on the same
  /// thread.
  virtual std::string reason() const { return {}; }
};

}  // namespace possibility::graph
