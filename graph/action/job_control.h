#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "common/cancellation_token.h"

namespace possibility::graph {

/// How a routine with its own handle is paused, resumed and cancelled from another thread. Each
/// function returns at once, does not throw and does not call the JobControl. `cancel` also ends a
/// pause. All three must be set.
struct JobSteering {
  std::function<void()> pause;
  std::function<void()> resume;
  std::function<void()> cancel;
};

/// Links a running routine with whoever pauses, resumes and cancels it: a confirmation job with its
/// ConfirmationQueue, a solve with the jobs that wait for it. Thread-safe: the routine calls the
/// first group of functions, other threads the second.
class JobControl {
 public:
  /// Starts unpaused. The job's thread calls `on_held` (optional) when a pause begins to hold it.
  explicit JobControl(std::function<void()> on_held = {}) : on_held_(std::move(on_held)) {}
  JobControl(const JobControl&) = delete;
  JobControl& operator=(const JobControl&) = delete;

  /// The job calls this every few milliseconds (at least every 20 ms). Sleeps while the job is
  /// paused. False once the job is cancelled: Run then returns without delay. Costs two atomic
  /// loads while no pause, cancellation or ration is pending.
  bool Checkpoint();
  /// For what takes no JobControl: asking it is a Checkpoint. For the job's thread alone; must not
  /// outlive the JobControl.
  CancellationToken token() {
    return CancellationToken([this] { return Checkpoint(); });
  }
  bool cancelled() const { return cancelled_.load(std::memory_order_acquire); }

  /// Runs `routine`, steered through its own handle meanwhile, and returns Checkpoint(). Exceptions
  /// of `routine` pass through. Does not nest. If turns are counted in checkpoints (Ration), a
  /// routine that never calls Charge runs to its end within one turn.
  bool RunSteered(const JobSteering& steering, const std::function<void()>& routine);
  /// Counts work of a steered routine as this many checkpoints. May be called on any thread.
  void Charge(std::int64_t checkpoints);

  /// Asks the job to pause. True if that holds it at once: a steered routine counts as held as soon
  /// as it is told. Otherwise false: `on_held` reports when the job is held, or has reported it
  /// already, or the job is cancelled.
  bool Pause();
  void Resume();
  /// Makes the job pause by itself at the last of this many checkpoints from here: always at the
  /// same place, unlike Pause. For jobs that are held or have not begun.
  void Ration(std::int64_t checkpoints);
  /// Cannot be undone.
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
