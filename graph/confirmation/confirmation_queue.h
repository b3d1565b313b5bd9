#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "common/deadline.h"
#include "graph/action/confirmation_job.h"
#include "graph/confirmation/job_rotation.h"
#include "graph/confirmation/queued_job.h"

namespace possibility::graph {

/// Q_Confirmation: runs jobs in rotation, one time slice each, so that easy jobs finish promptly
/// and difficult ones do not block them. Every job that has begun has a thread. The queue pauses
/// and resumes the threads so that no more jobs run than it has workers.
///
/// Order: jobs rank by the number of turns they have had, then by cost, cheapest first. The first
/// few rotate. One slice in `slices_per_fair_slice` goes to the job that has waited longest,
/// whatever its rank, so that no job starves.
///
/// With workers (LaunchThreads), all this happens beside the calling thread. Without workers,
/// RunTurn gives one job one turn while the calling thread waits. Such a turn is measured in
/// checkpoints instead of time, so the turn in which a job ends does not depend on the machine.
///
/// All functions are called from one thread.
class ConfirmationQueue {
 public:
  using Settings = RotationSettings;

  ConfirmationQueue();
  /// @throws std::invalid_argument unless every setting is positive.
  explicit ConfirmationQueue(const Settings& settings);
  ~ConfirmationQueue();
  ConfirmationQueue(const ConfirmationQueue&) = delete;
  ConfirmationQueue& operator=(const ConfirmationQueue&) = delete;

  /// Lets at most `workers` jobs run at once from now on. Call at most once. (A cancelled job
  /// returns without waiting for its turn.)
  void LaunchThreads(int workers);

  /// `cost`: the cost of the cheapest route that needs the job's answer. Cheaper jobs run first.
  void Insert(int tag, std::unique_ptr<ConfirmationJob> job, double cost);
  void SetCost(int tag, double cost);

  /// Cancels a job whose answer is no longer needed. Its result, kCancelled with this reason, can
  /// be drained once the job has ended. No effect if it has ended already.
  void Cancel(int tag, const std::string& reason);

  /// Number of jobs inserted and not yet drained.
  int num_open() const { return num_open_; }

  /// Takes the results of the jobs that ended since the last call, in the order they ended.
  std::vector<JobResult> DrainFinished();

  /// Waits until a result can be drained, at most `limit`. For queues with workers.
  void WaitForResult(std::chrono::milliseconds limit);

  /// Runs the next job until it ends, its turn is over, or the deadline passes. False if the job
  /// did not end; true if it ended or there is no job. The turn is `length` times as long as in the
  /// settings. For queues without workers.
  bool RunTurn(const Deadline& deadline, int length = 1);

  /// Cancels all jobs and waits for their threads, as long as the slowest job takes to return.
  void CancelAll(const std::string& reason);

 private:
  void RunJob(QueuedJob* job);
  void OnHeld(QueuedJob* job);
  // The functions below are called under mutex_.
  void Dispatch(const std::stop_token& stop, std::unique_lock<std::mutex>* lock);
  void EndSlices();
  void EndSlice(QueuedJob* job);
  void GrantPermits();
  bool Grant(QueuedJob* job, std::optional<std::int64_t> checkpoints = std::nullopt);
  void Reap();
  double TimeLeft(const QueuedJob& job) const;  ///< s, until the limit of single jobs
  std::int64_t CheckpointsOfTurn(const QueuedJob& job, int length) const;
  int NumWithState(QueuedJob::State a, QueuedJob::State b) const;
  std::optional<QueuedJob::Clock::time_point> NextSliceEnd() const;
  QueuedJob* Find(int tag) const;
  void Notify();

  Settings settings_;
  int num_open_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable_any event_;   ///< for the dispatcher and RunTurn: something happened
  std::condition_variable_any result_;  ///< a result can be drained
  // Under mutex_:
  bool news_ = false;
  int workers_ = 0;
  std::int64_t grants_ = 0;
  std::vector<std::unique_ptr<QueuedJob>> jobs_;
  std::vector<JobResult> finished_;

  std::jthread dispatcher_;
};

}  // namespace possibility::graph
