#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "graph/confirmation_job.h"
#include "graph/confirmation_report.h"

namespace possibility::graph {

struct JobResult {
  int tag = 0;  ///< as given to Insert
  JobOutcome outcome = JobOutcome::kFailed;
  std::string reason;  ///< the job's own if refuted, what it threw if failed
  double seconds = 0;  ///< spent in its slices
};

/// Q_Confirmation: runs jobs in rotation, a slice of time each, so that easy ones finish promptly
/// and difficult ones hold up nobody. With threads, a few jobs per thread rotate and the others
/// wait; a job that has used up its turn of slices goes behind those that wait. Without threads,
/// RunTurn gives one job one turn.
///
/// All functions but the jobs' own are called from one thread.
class ConfirmationQueue {
 public:
  struct Settings {
    std::chrono::milliseconds slice{10};
    int slices_per_turn = 300;
    int rotating_jobs_per_thread = 2;
  };

  ConfirmationQueue();
  explicit ConfirmationQueue(const Settings& settings);
  ~ConfirmationQueue();
  ConfirmationQueue(const ConfirmationQueue&) = delete;
  ConfirmationQueue& operator=(const ConfirmationQueue&) = delete;

  /// Starts `count` worker threads; once at most.
  void LaunchThreads(int count);

  void Insert(int tag, std::unique_ptr<ConfirmationJob> job);

  /// Jobs inserted and not yet drained or cancelled.
  int num_open() const { return num_open_; }

  /// Takes the results of the jobs that ended since the last call, in the order they ended.
  std::vector<JobResult> DrainFinished();

  /// Waits until a result can be drained, at most `limit`. For queues with threads.
  void WaitForResult(std::chrono::milliseconds limit);

  /// Runs the next waiting job until it ends, its turn is over, or `stop` says so between two
  /// slices. For queues without threads.
  void RunTurn(const std::function<bool()>& stop);

  /// Drops all jobs, running ones at the end of their slice, and ends the threads.
  void Cancel();

 private:
  struct Entry {
    int tag = 0;
    std::unique_ptr<ConfirmationJob> job;
    int slices = 0;
    double seconds = 0;
  };

  /// Runs one slice; true if the job ended, with its outcome in `result`.
  bool RunSlice(Entry* entry, JobResult* result) const;
  void Work(const std::stop_token& stop);
  Entry TakeNext();
  void PutBack(Entry entry);
  void FillRotation();

  Settings settings_;
  int num_open_ = 0;

  std::mutex mutex_;
  std::condition_variable_any work_or_stop_;
  std::condition_variable result_;
  // Under mutex_:
  std::deque<Entry> waiting_;
  std::deque<Entry> rotation_;
  int num_running_ = 0;
  int rotation_limit_ = 0;
  std::vector<JobResult> finished_;

  std::vector<std::jthread> threads_;
};

}  // namespace possibility::graph
