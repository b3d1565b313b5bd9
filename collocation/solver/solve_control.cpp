#include "collocation/solver/solve_control.h"

#include <chrono>

namespace possibility::collocation {

void SolveControl::Cancel() {
  {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
  }
  changed_.notify_all();
}

void SolveControl::Pause() {
  const std::lock_guard lock(mutex_);
  paused_ = true;
}

void SolveControl::Resume() {
  {
    const std::lock_guard lock(mutex_);
    paused_ = false;
  }
  changed_.notify_all();
}

double SolveControl::WaitWhilePaused() {
  if (!paused_.load(std::memory_order_relaxed)) return 0;
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !paused_ || cancelled_; });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace possibility::collocation
