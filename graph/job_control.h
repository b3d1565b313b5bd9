#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

namespace possibility::graph {

/// How a routine with a handle of its own is paused, resumed and cancelled from another thread.
/// Each function returns at once, throws nothing and asks nothing of the JobControl. `cancel`
/// also ends a pause. All three must be there.
struct JobSteering {
  std::function<void()> pause;
  std::function<void()> resume;
  std::function<void()> cancel;
};

/// What joins a running confirmation job to whoever runs it: a ConfirmationQueue, or a test.
/// Thread-safe: the job calls the first group of functions, other threads the second.
class JobControl {
 public:
  /// Not paused. `on_held` (optional) is called by the job's thread when a pause begins to hold it.
  explicit JobControl(std::function<void()> on_held = {}) : on_held_(std::move(on_held)) {}
  JobControl(const JobControl&) = delete;
  JobControl& operator=(const JobControl&) = delete;

  /// To be called by the job every few milliseconds (at least every 20): sleeps while the job is
  /// paused. False once it is cancelled: Run then returns without delay. Costs two atomic loads
  /// while nothing is asked of the job.
  bool Checkpoint();
  bool cancelled() const { return cancelled_.load(std::memory_order_acquire); }

  /// Runs `routine`, steered through its own handle meanwhile, and returns Checkpoint(). What
  /// `routine` throws passes through. Does not nest. Where turns are counted in checkpoints
  /// (Ration), a routine that is not charged for what it does gets to its end in one.
  bool RunSteered(const JobSteering& steering, const std::function<void()>& routine);
  /// Counts what a steered routine has done as so many checkpoints. For whatever thread runs it.
  void Charge(std::int64_t checkpoints);

  /// Asks the job to pause; true if that holds it at once: a steered routine counts as held as soon
  /// as it is told. False if `on_held` tells, or told, when it is.
  bool Pause();
  void Resume();
  /// The job is to pause by itself at the last of so many checkpoints from here: always at the same
  /// place, as an order from outside is not. For jobs that are held or have not begun.
  void Ration(std::int64_t checkpoints);
  /// Sticky.
  void Cancel();

 private:
  static constexpr std::int64_t kUnlimited = std::numeric_limits<std::int64_t>::max();

  void PauseFromWithin();
  void Attach(const JobSteering& steering);
  void Detach();

  std::function<void()> on_held_;
  std::atomic<bool> cancelled_ = false;
  std::atomic<bool> interrupted_ = false;  ///< paused_ or cancelled_
  std::atomic<std::int64_t> ration_ = kUnlimited;

  std::mutex mutex_;
  std::condition_variable changed_;
  // Under mutex_:
  bool paused_ = false;
  bool held_ = false;
  std::optional<JobSteering> steering_;
};

}  // namespace possibility::graph
