#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "graph/action/confirmation_job.h"
#include "graph/action/job_control.h"
#include "graph/confirmation/confirmation_report.h"

namespace possibility::graph {

struct JobResult {
  int tag = 0;  ///< as given to ConfirmationQueue::Insert
  JobOutcome outcome = JobOutcome::kFailed;
  std::string reason;  ///< as in ConfirmationReport
  double seconds = 0;  ///< running time, without pauses
};

/// A job of a ConfirmationQueue and, once it has begun, its thread. All members are guarded by the
/// queue's mutex.
struct QueuedJob {
  using Clock = std::chrono::steady_clock;
  enum class State { kWaiting, kRunning, kPausing, kPaused, kEnded };

  /// A verdict of the queue that replaces the job's own.
  struct Overruling {
    JobOutcome outcome = JobOutcome::kCancelled;
    std::string reason;
  };

  /// `on_held` is called by the job's thread, without the mutex, when a pause begins to hold it.
  QueuedJob(int tag, std::unique_ptr<ConfirmationJob> job, double cost,
            std::function<void(QueuedJob*)> on_held);

  bool HasThread() const { return thread.joinable(); }
  /// Adds the elapsed time of the current slice to `seconds`.
  void AddUp();
  /// Cancels the job, unless it has ended or was overruled before.
  void Overrule(JobOutcome outcome, const std::string& reason);
  /// Only for a job that has ended; waits for its thread.
  JobResult TakeResult();

  int tag;
  double cost;
  double work_of_checkpoint;  ///< the job's own, which ends before this, s
  bool bounds_its_effort;     ///< ConfirmationJob
  std::unique_ptr<ConfirmationJob> job;
  JobControl control;
  State state = State::kWaiting;
  std::optional<Overruling> overruling;
  JobResult result;
  std::int64_t slices = 0;
  double seconds = 0;
  std::int64_t last_served = 0;  ///< grants counter when it was inserted or last resumed
  Clock::time_point slice_begin;
  std::thread thread;
};

/// Runs a job to its end and returns its verdict, or why there is none. Runs on the job's thread,
/// without the mutex.
JobResult Examine(ConfirmationJob* job, JobControl* control);

/// "no verdict after 30 s", followed by `why`.
std::string NoVerdictAfter(double seconds, const std::string& why);

}  // namespace possibility::graph
