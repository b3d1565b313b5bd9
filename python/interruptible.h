#pragma once

#include <functional>

#include "common/cancellation_token.h"

namespace possibility::python {

/// Runs `work` on a thread of its own. The calling thread, which holds Python's lock, lends it out,
/// and every 10 ms asks Python for signals and calls `poll`, which may be empty.
///
/// If a signal handler or `poll` raises, the work is cancelled and the exception passes on at once.
/// Work that does not end within 10 ms is left to wind down by itself, so it must own what it uses,
/// and must not touch Python. @throws What the work throws.
void RunInterruptibly(std::function<void(const CancellationToken&)> work,
                      const std::function<void()>& poll = {});

/// Waits for work that was left to wind down; for the end of the interpreter.
void AwaitAbandonedWork();

}  // namespace possibility::python
