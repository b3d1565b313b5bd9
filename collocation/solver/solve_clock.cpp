#include "collocation/solver/solve_clock.h"

namespace possibility::collocation {

SolveClock::SolveClock(double time_limit, SolveControl* control)
    : start_(std::chrono::steady_clock::now()), time_limit_(time_limit), control_(control) {}

bool SolveClock::Proceed() {
  if (stop_ != Stop::kNone) return false;
  if (control_ != nullptr) {
    paused_ += control_->WaitWhilePaused();
    if (control_->cancelled()) stop_ = Stop::kCancelled;
  }
  if (stop_ == Stop::kNone && time_limit_ > 0 && Seconds() > time_limit_) stop_ = Stop::kTimeLimit;
  return stop_ == Stop::kNone;
}

bool SolveClock::EndIteration() {
  if (control_ != nullptr) control_->EndIteration();
  return Proceed();
}

double SolveClock::Seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() - paused_;
}

}  // namespace possibility::collocation
