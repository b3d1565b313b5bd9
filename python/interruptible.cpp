#include "python/interruptible.h"

#include <pybind11/pybind11.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace possibility::python {
namespace {

constexpr std::chrono::milliseconds kPollInterval{10};
constexpr std::chrono::milliseconds kPatience{10};  // with cancelled work

/// Work on a thread of its own.
class BackgroundWork {
 public:
  explicit BackgroundWork(std::function<void(const CancellationToken&)> work)
      : work_(std::move(work)), thread_([this] { Run(); }) {}

  void Cancel() { cancelled_ = true; }

  /// Whether the work ends within `time`.
  bool EndsWithin(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return has_ended_; });
  }

  bool HasEnded() { return EndsWithin(std::chrono::milliseconds(0)); }

  /// Of work that has ended.
  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void Run() {
    try {
      work_(CancellationToken([this] { return !cancelled_; }));
    } catch (...) {
      error_ = std::current_exception();
    }
    work_ = {};
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    ended_.notify_all();
  }

  std::function<void(const CancellationToken&)> work_;
  std::exception_ptr error_;
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::jthread thread_;  // last, so that it is joined first
};

/// Touched with Python's lock held only.
std::vector<std::unique_ptr<BackgroundWork>>& Abandoned() {
  static std::vector<std::unique_ptr<BackgroundWork>> abandoned;
  return abandoned;
}

bool EndsUnlocked(BackgroundWork* work, std::chrono::milliseconds time) {
  const pybind11::gil_scoped_release release;
  return work->EndsWithin(time);
}

void Abandon(std::unique_ptr<BackgroundWork> work) {
  work->Cancel();
  if (EndsUnlocked(work.get(), kPatience)) return;
  std::erase_if(Abandoned(), [](const auto& other) { return other->HasEnded(); });
  Abandoned().push_back(std::move(work));
}

}  // namespace

void RunInterruptibly(std::function<void(const CancellationToken&)> work,
                      const std::function<void()>& poll) {
  auto background = std::make_unique<BackgroundWork>(std::move(work));
  try {
    while (!EndsUnlocked(background.get(), kPollInterval)) {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (poll) poll();
    }
  } catch (...) {
    Abandon(std::move(background));
    throw;
  }
  background->Rethrow();
}

void AwaitAbandonedWork() {
  std::vector<std::unique_ptr<BackgroundWork>> abandoned;
  abandoned.swap(Abandoned());
  const pybind11::gil_scoped_release release;
  abandoned.clear();
}

}  // namespace possibility::python
