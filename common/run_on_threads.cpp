#include "common/run_on_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
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
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::size_t failed = count;  // the least index whose call threw
  std::exception_ptr fault;
  const auto fail = [&](std::size_t i) {
    const std::lock_guard lock(mutex);
    if (i >= failed) return;
    failed = i;
    fault = std::current_exception();
    next = count;
  };
  RunOnThreads(static_cast<int>(std::min<std::size_t>(std::max(1, threads), count)), [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        fail(i);
      }
    }
  });
  if (fault) std::rethrow_exception(fault);
}

}  // namespace possibility
