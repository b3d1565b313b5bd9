#include "collocation/solver/solve_clock.h"

#include <utility>

namespace possibility::collocation {

SolveClock::SolveClock(double time_limit, CancellationToken cancellation)
    : time_limit_(time_limit), cancellation_(std::move(cancellation)) {}

bool SolveClock::Proceed() {
  if (stop_ != Stop::kNone) return false;
  const double asked = stopwatch_.Seconds();
  const bool may_proceed = cancellation_.Proceed();
  paused_ += stopwatch_.Seconds() - asked;
  if (!may_proceed) {
    stop_ = Stop::kCancelled;
  } else if (time_limit_ > 0 && Seconds() > time_limit_) {
    stop_ = Stop::kTimeLimit;
  }
  return stop_ == Stop::kNone;
}

}  // namespace possibility::collocation
