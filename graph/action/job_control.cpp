#include "graph/action/job_control.h"

#include <utility>

namespace possibility::graph {

bool JobControl::Checkpoint() {
  Charge(1);
  if (!interrupted_.load(std::memory_order_acquire)) {
    return true;
  }
  std::unique_lock lock(mutex_);
  while (paused_ && !cancelled()) {
    if (!std::exchange(held_, true) && on_held_) {
      lock.unlock();
      on_held_();
      lock.lock();
      continue;
    }
    changed_.wait(lock);
  }
  return !cancelled();
}

bool JobControl::RunSteered(const JobSteering& steering, const std::function<void()>& routine) {
  if (!Checkpoint()) {
    return false;
  }
  Attach(steering);
  try {
    routine();
  } catch (...) {
    Detach();
    throw;
  }
  Detach();
  return Checkpoint();
}

void JobControl::Charge(std::int64_t checkpoints) {
  if (ration_.load(std::memory_order_relaxed) != kUnlimited &&
      ration_.fetch_sub(checkpoints) <= checkpoints) {
    PauseFromWithin();
  }
}

void JobControl::Ration(std::int64_t checkpoints) { ration_ = checkpoints; }

bool JobControl::Pause() {
  const std::lock_guard lock(mutex_);
  if (cancelled()) {
    return false;
  }
  paused_ = true;
  interrupted_.store(true, std::memory_order_release);
  if (!steering_ || std::exchange(held_, true)) {
    return false;
  }
  steering_->pause();
  return true;
}

void JobControl::PauseFromWithin() {
  if (Pause() && on_held_) {
    on_held_();
  }
}

void JobControl::Resume() {
  const std::lock_guard lock(mutex_);
  if (cancelled()) {
    return;
  }
  paused_ = false;
  interrupted_.store(false, std::memory_order_release);
  if (std::exchange(held_, false) && steering_) {
    steering_->resume();
  }
  changed_.notify_all();
}

void JobControl::Cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_.store(true, std::memory_order_release);
  interrupted_.store(true, std::memory_order_release);
  if (steering_) {
    steering_->cancel();
  }
  changed_.notify_all();
}

void JobControl::Attach(const JobSteering& steering) {
  bool begins_to_hold = false;
  {
    const std::lock_guard lock(mutex_);
    steering_ = steering;
    if (cancelled()) {
      steering_->cancel();
    } else if (paused_) {
      steering_->pause();
      begins_to_hold = !std::exchange(held_, true);
    }
  }
  if (begins_to_hold && on_held_) {
    on_held_();
  }
}

void JobControl::Detach() {
  const std::lock_guard lock(mutex_);
  steering_.reset();
}

}  // namespace possibility::graph
