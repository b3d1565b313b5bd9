#include "graph/action/shared_work.h"

#include <utility>

namespace possibility::graph {

/// A job's wait, from its request until the routine has ended or the job gives up. The routine
/// works for it while it is inside and not paused. Pauses and resumes may come before it is inside,
/// in any number and order.
class SharedWork::Visit {
 public:
  Visit(SharedWork* work, JobControl* visitor) : work_(*work), visitor_(visitor) {
    const std::lock_guard lock(work_.visitors_mutex_);
    work_.visitors_.push_back(visitor_);
  }
  ~Visit() {
    Set(&inside_, false);
    const std::lock_guard lock(work_.visitors_mutex_);
    std::erase(work_.visitors_, visitor_);
  }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

  bool Await() {
    bool has_ended = false;
    const bool go_on = visitor_->RunSteered({.pause = [this] { Set(&paused_, true); },
                                             .resume = [this] { Set(&paused_, false); },
                                             .cancel = [this] { GiveUp(); }},
                                            [&] {
                                              Set(&inside_, true);
                                              has_ended = work_.WaitForEnd(gave_up_);
                                            });
    return go_on && has_ended;
  }

 private:
  void Set(bool* what, bool value) {
    const std::lock_guard lock(mutex_);
    *what = value;
    const bool wants = inside_ && !paused_;
    if (wants != wants_) work_.Want(wants ? 1 : -1);
    wants_ = wants;
  }

  void GiveUp() {
    gave_up_ = true;
    work_.Wake();
  }

  SharedWork& work_;
  JobControl* visitor_;
  std::atomic<bool> gave_up_ = false;
  std::mutex mutex_;
  // Under mutex_:
  bool inside_ = false;
  bool paused_ = false;
  bool wants_ = false;
};

SharedWork::SharedWork(std::function<void(SharedWork* self)> routine) {
  control_.Pause();
  worker_ = std::jthread([this, routine = std::move(routine)] { Work(routine); });
}

SharedWork::~SharedWork() { control_.Cancel(); }

bool SharedWork::Await(JobControl* job) { return Visit(this, job).Await(); }

CancellationToken SharedWork::charging_token() {
  return CancellationToken([this] {
    Charge(1);
    return control_.Checkpoint();
  });
}

void SharedWork::Charge(std::int64_t checkpoints) {
  const std::lock_guard lock(visitors_mutex_);
  for (JobControl* visitor : visitors_) visitor->Charge(checkpoints);
}

void SharedWork::Want(int change) {
  const std::lock_guard lock(mutex_);
  wanted_ += change;
  if (wanted_ > 0) {
    control_.Resume();
  } else {
    control_.Pause();
  }
}

bool SharedWork::WaitForEnd(const std::atomic<bool>& gave_up) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return has_ended_ || gave_up; });
  if (error_ && !gave_up) std::rethrow_exception(error_);
  return has_ended_ && !gave_up;
}

void SharedWork::Wake() {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

void SharedWork::Work(const std::function<void(SharedWork*)>& routine) {
  std::exception_ptr error;
  // The first checkpoint waits for the first visitor.
  if (control_.Checkpoint()) {
    try {
      routine(this);
    } catch (...) {
      error = std::current_exception();
    }
  }
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  error_ = error;
  changed_.notify_all();
}

}  // namespace possibility::graph
