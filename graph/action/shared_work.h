#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "common/cancellation_token.h"
#include "graph/action/job_control.h"

namespace possibility::graph {

/// A routine whose result several jobs need. Jobs begin and end as the search's interest in edges
/// changes; the routine's progress survives them. It works only while some job waits for it, and
/// charges its work to those jobs as checkpoints.
class SharedWork {
 public:
  /// The routine runs once, on a thread of its own, from the first Await on.
  explicit SharedWork(std::function<void(SharedWork* self)> routine);
  /// Cancels the routine and waits until it has returned.
  ~SharedWork();
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  /// For jobs: waits until the routine has ended. The routine works for the job while the job is
  /// not paused. False if the job is cancelled before.
  /// @throws what the routine has thrown.
  bool Await(JobControl* job);

  /// For the routine: whether it may go on. Asking costs the waiting jobs nothing.
  CancellationToken token() { return control_.token(); }
  /// For the routine: likewise, and every question is a checkpoint of all waiting jobs.
  CancellationToken charging_token();
  /// For the routine: counts its work as this many checkpoints of all waiting jobs.
  void Charge(std::int64_t checkpoints);

 private:
  class Visit;

  void Work(const std::function<void(SharedWork*)>& routine);
  /// Changes the number of waiting jobs by `change` (1 or -1).
  void Want(int change);
  /// False once `gave_up` is true; Wake announces that.
  bool WaitForEnd(const std::atomic<bool>& gave_up);
  void Wake();

  JobControl control_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Under mutex_:
  int wanted_ = 0;
  bool has_ended_ = false;
  std::exception_ptr error_;

  std::mutex visitors_mutex_;
  std::vector<JobControl*> visitors_;
  std::jthread worker_;
};

}  // namespace possibility::graph
