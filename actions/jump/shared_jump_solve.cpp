#include "actions/jump/shared_jump_solve.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace possibility::actions {
namespace {

/// An iteration of a jump takes about 25 ms on our machines, as long as several checkpoints of
/// other work. A jump that does not fit into one turn of 1000 checkpoints is a difficult one
/// (median: 54 iterations).
constexpr std::int64_t kCheckpointsPerIteration = 10;

}  // namespace

/// A job's wait, from its request until it has the answer or gives up. The solve works for it while
/// it is inside and not paused. Pauses and resumes may come before it is inside, in any number and
/// order.
class SharedJumpSolve::Visit {
 public:
  Visit(SharedJumpSolve* solve, graph::JobControl* visitor) : solve_(*solve), visitor_(visitor) {
    const std::lock_guard lock(solve_.visitors_mutex_);
    solve_.visitors_.push_back(visitor_);
  }
  ~Visit() {
    Set(&inside_, false);
    const std::lock_guard lock(solve_.visitors_mutex_);
    std::erase(solve_.visitors_, visitor_);
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  std::optional<JumpAnswer> Await() {
    std::optional<JumpAnswer> answer;
    const bool go_on = visitor_->RunSteered({.pause = [this] { Set(&paused_, true); },
                                             .resume = [this] { Set(&paused_, false); },
                                             .cancel = [this] { GiveUp(); }},
                                            [&] {
                                              Set(&inside_, true);
                                              answer = solve_.Wait(gave_up_);
                                            });
    return go_on ? answer : std::nullopt;
  }

 private:
  void Set(bool* what, bool value) {
    const std::lock_guard lock(mutex_);
    *what = value;
    const bool wants = inside_ && !paused_;
    if (wants != wants_) solve_.Want(wants ? 1 : -1);
    wants_ = wants;
  }

  void GiveUp() {
    gave_up_ = true;
    solve_.Wake();
  }

  SharedJumpSolve& solve_;
  graph::JobControl* visitor_;
  std::atomic<bool> gave_up_ = false;
  std::mutex mutex_;
  // Under mutex_:
  bool inside_ = false;
  bool paused_ = false;
  bool wants_ = false;
};

SharedJumpSolve::SharedJumpSolve(JumpLibrary* library, const JumpTask& task)
    : task_(task), library_(library) {
  solve_.Pause();
  worker_ = std::jthread([this] { Work(); });
}

SharedJumpSolve::~SharedJumpSolve() { solve_.Cancel(); }

std::optional<JumpAnswer> SharedJumpSolve::Await(graph::JobControl* control) {
  return Visit(this, control).Await();
}

void SharedJumpSolve::ChargeVisitors() {
  const std::lock_guard lock(visitors_mutex_);
  for (graph::JobControl* visitor : visitors_) visitor->Charge(kCheckpointsPerIteration);
}

void SharedJumpSolve::Want(int change) {
  const std::lock_guard lock(mutex_);
  wanted_ += change;
  if (wanted_ > 0) {
    solve_.Resume();
  } else {
    solve_.Pause();
  }
}

std::optional<JumpAnswer> SharedJumpSolve::Wait(const std::atomic<bool>& gave_up) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return answer_.has_value() || error_ || gave_up; });
  if (error_ && !gave_up) std::rethrow_exception(error_);
  return gave_up ? std::nullopt : answer_;
}

void SharedJumpSolve::Wake() {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

void SharedJumpSolve::Work() {
  solve_.Checkpoint();  // waits for the first visitor
  std::optional<JumpAnswer> answer;
  std::exception_ptr error;
  try {
    answer = library_->FindOrSolve(
        task_, solve_.token(), [this](const collocation::SolverIteration&) { ChargeVisitors(); });
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  answer_ = std::move(answer);
  error_ = error;
  changed_.notify_all();
}

}  // namespace possibility::actions
