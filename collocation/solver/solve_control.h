#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <utility>

namespace possibility::collocation {

/// Lets another thread pause, resume and cancel a running solve. Thread-safe. Orders stay in force:
/// a solve that starts after Cancel ends at once.
class SolveControl {
 public:
  SolveControl() = default;
  /// The solve's thread calls `on_iteration` after each iteration, before it checks whether to go
  /// on. Orders given by `on_iteration` thus always take effect in the same place.
  explicit SolveControl(std::function<void()> on_iteration)
      : on_iteration_(std::move(on_iteration)) {}

  void Cancel();
  void Pause();
  void Resume();
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  /// The solve calls this often. Sleeps while paused, without using processor time. Returns the
  /// time slept, s.
  double WaitWhilePaused();
  /// Called by the solve.
  void EndIteration() const {
    if (on_iteration_) on_iteration_();
  }

 private:
  std::function<void()> on_iteration_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> paused_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace possibility::collocation
