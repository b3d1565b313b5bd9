#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

#include "graph/action/job_control.h"

namespace possibility::graph::test {

/// A routine that is paused and cancelled from outside and knows nothing of JobControl.
class SteeredRoutine {
 public:
  JobSteering Steering() {
    return {.pause = [this] { Set(&paused_, true); },
            .resume = [this] { Set(&paused_, false); },
            .cancel = [this] { Set(&cancelled_, true); }};
  }
  /// Runs until `step`, called every millisecond, returns false, or until it is cancelled.
  void Run(const std::function<bool()>& step) {
    while (step()) {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(1));
      changed_.wait(lock, [this] { return !paused_ || cancelled_; });
      if (cancelled_) {
        return;
      }
    }
  }

 private:
  void Set(bool* what, bool value) {
    const std::lock_guard lock(mutex_);
    *what = value;
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool paused_ = false;
  bool cancelled_ = false;
};

}  // namespace possibility::graph::test
