#include "actions/shared_jump_solve.h"

#include <functional>
#include <utility>

namespace possibility::actions {

SharedJumpSolve::SharedJumpSolve(JumpLibrary* library, const JumpTask& task)
    : task_(task), library_(library) {
  solve_.Pause();
  worker_ = std::jthread([this] { Work(); });
}

SharedJumpSolve::~SharedJumpSolve() { solve_.Cancel(); }

std::optional<JumpAnswer> SharedJumpSolve::Await(graph::JobControl* control) {
  std::atomic<bool> gave_up = false;
  std::optional<JumpAnswer> answer;
  std::mutex mutex;
  bool wants = false;
  // Pauses and their ends may come in any number and order.
  const auto want = [&](bool wish) {
    const std::lock_guard lock(mutex);
    if (wants != wish) Want(wish ? 1 : -1);
    wants = wish;
  };
  struct Farewell {
    std::function<void()> leave;
    ~Farewell() { leave(); }
  } farewell{[&] { want(false); }};
  want(true);
  const bool go_on = control->RunSteered({.pause = [&] { want(false); },
                                          .resume = [&] { want(true); },
                                          .cancel =
                                              [&] {
                                                gave_up = true;
                                                Wake();
                                              }},
                                         [&] { answer = Wait(gave_up); });
  return go_on ? answer : std::nullopt;
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
  solve_.WaitWhilePaused();
  std::optional<JumpAnswer> answer;
  std::exception_ptr error;
  try {
    answer = library_->FindOrSolve(task_, &solve_);
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  answer_ = std::move(answer);
  error_ = error;
  changed_.notify_all();
}

}  // namespace possibility::actions
