#pragma once

#include <cstddef>
#include <functional>

namespace possibility {

/// Runs `work` on `threads` threads, this one included, and waits for all. `work` must not throw.
void RunOnThreads(int threads, const std::function<void()>& work);

/// Calls `work` with 0 to `count` - 1, several at a time. If calls throw, the exception of the
/// least index is thrown, and calls of greater ones may be left out.
void ForEachOnThreads(int threads, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace possibility
