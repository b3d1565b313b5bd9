#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "actions/jump/jump_library.h"
#include "collocation/solver/solve_control.h"
#include "graph/job_control.h"

namespace possibility::actions {

/// The answer to one task, for all jobs that want it. Jobs come and go with the edges that the
/// search takes an interest in; what is solved so far must not go with them. Works only while some
/// job asks for it, and counts on their checkpoints by its iterations. The library has to outlive
/// it.
class SharedJumpSolve {
 public:
  SharedJumpSolve(JumpLibrary* library, const JumpTask& task);
  ~SharedJumpSolve();

  const JumpTask& task() const { return task_; }

  /// To be called by a job: waits for the answer, wanting it while the job is not paused. None if
  /// the job is cancelled.
  /// @throws what JumpLibrary::FindOrSolve throws.
  std::optional<JumpAnswer> Await(graph::JobControl* control);

 private:
  class Visit;

  void Work();
  void ChargeVisitors();
  /// One job more, or one less, wants it now.
  void Want(int change);
  /// None if `gave_up`, which Wake announces, became true.
  std::optional<JumpAnswer> Wait(const std::atomic<bool>& gave_up);
  void Wake();

  JumpTask task_;
  JumpLibrary* library_;
  collocation::SolveControl solve_;
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
