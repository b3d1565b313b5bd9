#include "common/run_on_threads.h"

#include <algorithm>
#include <thread>
#include <vector>

namespace possibility {

void RunOnThreads(int threads, const std::function<void()>& work) {
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

void ForEachOnThreads(int threads, std::size_t count,
                      const std::function<void(std::size_t)>& work) {
  SharedCalls calls(count, work);
  RunOnThreads(static_cast<int>(std::min<std::size_t>(std::max(1, threads), count)),
               [&] { calls.Run(); });
  calls.ThrowIfFailed();
}

void SharedCalls::Run() {
  for (std::size_t i = next_++; i < count_; i = next_++) {
    try {
      work_(i);
    } catch (...) {
      Fail(i);
    }
  }
}

void SharedCalls::Fail(std::size_t index) {
  const std::lock_guard lock(mutex_);
  if (index >= failed_) return;
  failed_ = index;
  fault_ = std::current_exception();
  next_ = count_;
}

void SharedCalls::ThrowIfFailed() const {
  if (fault_) std::rethrow_exception(fault_);
}

}  // namespace possibility
