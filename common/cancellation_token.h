#pragma once

#include <functional>
#include <memory>
#include <stdexcept>

#include "common/deadline.h"

namespace possibility {

/// Thrown by work that its CancellationToken ended.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

/// Tells a piece of work whether it may go on. The work asks every few milliseconds; whoever
/// ordered it answers: a deadline, a source that other threads steer, or a function. Cheap to copy;
/// copies ask the same source, which must outlive their use.
///
/// Threads: any thread may ask a token of a deadline. The token of another source may be asked from
/// the threads that its maker allows (graph::JobControl: the job's own). A function that takes a
/// token asks it on the calling thread alone, unless it says otherwise.
///
/// Pauses: a source that can pause its work holds the thread that asks, without using processor
/// time, until the work is resumed or cancelled. The work sees nothing of the pause but the time
/// that the question took.
class CancellationToken {
 public:
  /// Never cancels.
  CancellationToken() = default;
  /// Cancels when the deadline, which is copied, has passed.
  explicit CancellationToken(const Deadline& deadline);
  /// Cancels once `proceed` returns false; from then on it must return false. Empty: never.
  explicit CancellationToken(std::function<bool()> proceed);

  /// Whether the work may go on. May sleep while the work is paused.
  bool Proceed() const { return proceed_ == nullptr || (*proceed_)(); }

  /// Proceed, for work that ends by an exception. @throws Cancelled.
  void ThrowIfCancelled() const {
    if (!Proceed()) throw Cancelled();
  }

 private:
  std::shared_ptr<const std::function<bool()>> proceed_;
};

}  // namespace possibility
