#pragma once

#include <chrono>

#include "collocation/solver/solve_control.h"

namespace possibility::collocation {

/// The time of one solve since construction, and the orders that it receives from outside.
class SolveClock {
 public:
  enum class Stop { kNone, kCancelled, kTimeLimit };

  /// `time_limit` in s, 0 for none; `control` may be null.
  SolveClock(double time_limit, SolveControl* control);

  /// Whether the solve may go on; sleeps while it is paused. Once false, always false.
  bool Proceed();
  /// Reports the end of an iteration; then like Proceed.
  bool EndIteration();
  Stop stop() const { return stop_; }

  /// s since construction, without pauses.
  double Seconds() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double time_limit_;
  SolveControl* control_;
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
