#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <utility>

namespace possibility::collocation {

/// The handle by which another thread steers a running solve. Thread-safe; sticky: a solve that
/// starts after Cancel ends at once.
class SolveControl {
 public:
  SolveControl() = default;
  /// `on_iteration` is called by the solve's thread after each iteration, before it asks whether to
  /// go on: what `on_iteration` orders takes effect in the same place every time.
  explicit SolveControl(std::function<void()> on_iteration)
      : on_iteration_(std::move(on_iteration)) {}

  void Cancel();
  void Pause();
  void Resume();
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  /// Called by the solve, often: sleeps while paused, without using processor time. Returns the
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
