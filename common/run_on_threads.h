#pragma once

#include <functional>

namespace possibility {

/// Runs `work` on `threads` threads, this one included, and waits for all. `work` must not throw.
void RunOnThreads(int threads, const std::function<void()>& work);

}  // namespace possibility
