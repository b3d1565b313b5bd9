#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "actions/jump/jump_library.h"
#include "graph/action/job_control.h"

namespace possibility::actions {

/// Solves one task for all jobs that need the answer. Jobs start and end as the search's interest
/// in edges changes; the progress of the solve must survive them. Works only while some job waits
/// for it, and charges its iterations to those jobs as checkpoints. The library must outlive it.
class SharedJumpSolve {
 public:
  SharedJumpSolve(JumpLibrary* library, const JumpTask& task);
  ~SharedJumpSolve();

  const JumpTask& task() const { return task_; }

  /// For jobs: waits for the answer. The solve works for the job while the job is not paused. None
  /// if the job is cancelled.
  /// @throws as JumpLibrary::FindOrSolve.
  std::optional<JumpAnswer> Await(graph::JobControl* control);

 private:
  class Visit;

  void Work();
  void ChargeVisitors();
  /// Changes the number of waiting jobs by `change` (1 or -1).
  void Want(int change);
  /// None once `gave_up` is true; Wake announces that.
  std::optional<JumpAnswer> Wait(const std::atomic<bool>& gave_up);
  void Wake();

  JumpTask task_;
  JumpLibrary* library_;
  graph::JobControl solve_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int wanted_ = 0;
  std::optional<JumpAnswer> answer_;
  std::exception_ptr error_;
  std::mutex visitors_mutex_;
  std::vector<graph::JobControl*> visitors_;
  std::jthread worker_;
};

}  // namespace possibility::actions
