#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "graph/confirmation/queued_job.h"

namespace possibility::graph {

struct RotationSettings {
  std::chrono::milliseconds slice{40};
  int slices_per_turn = 75;
  /// Instead of slices, for queues without workers: checkpoints of ConfirmationJob's default work.
  std::int64_t checkpoints_per_turn = 1000;
  int rotating_jobs_per_worker = 2;
  int slices_per_fair_slice = 8;
  int max_threads = 32;        ///< jobs begun and not ended; the slowest gives way to new ones
  double job_time_limit = 30;  ///< s of its own running time, after which a job has failed,
                               ///< unless it bounds its effort itself
};

/// Picks the next job by the queue's policy (see ConfirmationQueue); null if none is runnable.
/// `grants`: slices granted so far. If new jobs find no free thread, a slow job is overruled.
QueuedJob* PickNext(const std::vector<std::unique_ptr<QueuedJob>>& jobs,
                    const RotationSettings& settings, int num_rotating, std::int64_t grants);

}  // namespace possibility::graph
