#include "common/thread_team.h"

namespace possibility {

ThreadTeam::ThreadTeam(int threads) {
  for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { Help(); });
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  has_work_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadTeam::ForEach(std::size_t count, const std::function<void(std::size_t)>& work) {
  SharedCalls calls(count, work);
  if (!helpers_.empty() && count > 1) {
    const std::lock_guard lock(mutex_);
    calls_ = &calls;
  }
  has_work_.notify_all();
  calls.Run();
  {
    std::unique_lock lock(mutex_);
    calls_ = nullptr;
    is_done_.wait(lock, [this] { return helping_ == 0; });
  }
  calls.ThrowIfFailed();
}

void ThreadTeam::Help() {
  std::unique_lock lock(mutex_);
  while (true) {
    has_work_.wait(lock, [this] { return ends_ || calls_ != nullptr; });
    if (ends_) return;
    SharedCalls* calls = calls_;
    ++helping_;
    lock.unlock();
    calls->Run();
    lock.lock();
    // Nothing is left of it.
    if (calls_ == calls) calls_ = nullptr;
    if (--helping_ == 0) is_done_.notify_one();
  }
}

}  // namespace possibility
