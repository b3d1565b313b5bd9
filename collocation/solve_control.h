#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>

namespace possibility::collocation {

/// The handle by which another thread steers a running solve. Thread-safe; sticky: a solve that
/// starts after Cancel ends at once.
class SolveControl {
 public:
  void Cancel();
  void Pause();
  void Resume();
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

  /// Called by the solve, often: sleeps while paused, without using processor time. Returns the
  /// time slept, s.
  double WaitWhilePaused();

 private:
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> paused_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
};

}  // namespace possibility::collocation
