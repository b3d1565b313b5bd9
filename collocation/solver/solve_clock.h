#pragma once

#include "common/cancellation_token.h"
#include "common/stopwatch.h"

namespace possibility::collocation {

/// The time of one solve since construction, and whether it may go on. Pauses of the solve are the
/// time that its token took to answer.
class SolveClock {
 public:
  enum class Stop { kNone, kCancelled, kTimeLimit };

  /// `time_limit` in s, 0 for none.
  SolveClock(double time_limit, CancellationToken cancellation);

  /// Whether the solve may go on; sleeps while it is paused. Once false, always false.
  bool Proceed();
  /// Asks Proceed; must not outlive the clock.
  CancellationToken token() {
    return CancellationToken([this] { return Proceed(); });
  }
  Stop stop() const { return stop_; }

  /// s since construction, without pauses.
  double Seconds() const { return stopwatch_.Seconds() - paused_; }

 private:
  Stopwatch stopwatch_;
  double time_limit_;
  CancellationToken cancellation_;
  double paused_ = 0;
  Stop stop_ = Stop::kNone;
};

/// Adds the time from construction to destruction, without pauses, to `*seconds`.
class SolveTimer {
 public:
  SolveTimer(const SolveClock& clock, double* seconds)
      : clock_(clock), seconds_(seconds), start_(clock.Seconds()) {}
  ~SolveTimer() { *seconds_ += clock_.Seconds() - start_; }
  SolveTimer(const SolveTimer&) = delete;
  SolveTimer& operator=(const SolveTimer&) = delete;

 private:
  const SolveClock& clock_;
  double* seconds_;
  double start_;
};

}  // namespace possibility::collocation
