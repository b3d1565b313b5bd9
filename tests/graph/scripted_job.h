#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "graph/action/confirmation_job.h"

namespace possibility::graph::test {

enum class Ending { kConfirm, kRefute, kThrow, kGiveUp, kNonsense, kNever };

/// A job that ends in a given way after a given number of steps.
class ScriptedJob : public ConfirmationJob {
 public:
  ScriptedJob(Ending ending, int steps, std::chrono::microseconds per_step = {})
      : ending_(ending), steps_(steps), per_step_(per_step) {}

  JobVerdict Run(JobControl* control) override {
    const bool never = ending_ == Ending::kNever;
    for (int step = 0; never || step < steps_; ++step) {
      if (!control->Checkpoint()) {
        return JobVerdict::kRefuted;  // the verdict of a cancelled job must be ignored
      }
      Work();
      std::this_thread::sleep_for(never ? std::max(per_step_, kPoll) : per_step_);
    }
    switch (ending_) {
      case Ending::kConfirm:
        return JobVerdict::kConfirmed;
      case Ending::kThrow:
        throw std::runtime_error("solver broke down");
      case Ending::kGiveUp:
        return JobVerdict::kUndecided;
      case Ending::kNonsense:
        return static_cast<JobVerdict>(17);
      default:
        return JobVerdict::kRefuted;
    }
  }
  std::string reason() const override {
    return ending_ == Ending::kGiveUp ? "too many iterations" : "torque limit";
  }

 protected:
  /// What the test does in every step.
  virtual void Work() {}

 private:
  static constexpr std::chrono::microseconds kPoll{500};

  Ending ending_;
  int steps_;
  std::chrono::microseconds per_step_;
};

}  // namespace possibility::graph::test
