#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>

namespace possibility {

/// Runs `work` on `threads` threads, this one included, and waits for all. `work` must not throw.
void RunOnThreads(int threads, const std::function<void()>& work);

/// Calls `work` with 0 to `count` - 1, several at a time. If calls throw, the exception of the
/// least index is thrown, and calls of greater ones may be left out.
void ForEachOnThreads(int threads, std::size_t count, const std::function<void(std::size_t)>& work);

/// Calls of `work` with 0 to `count` - 1 that threads share. `work` must outlive it.
class SharedCalls {
 public:
  SharedCalls(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work), failed_(count) {}

  /// Makes calls until none is left to begin. Any number of threads may run it at once.
  void Run();
  /// Once all threads have run it: throws the exception of the least index whose call threw. Calls
  /// of greater ones may have been left out.
  void ThrowIfFailed() const;

 private:
  void Fail(std::size_t index);

  std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::size_t failed_;  ///< the least index whose call threw
  std::exception_ptr fault_;
};

}  // namespace possibility
