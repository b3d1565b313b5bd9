#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "graph/confirmation_job.h"

namespace possibility::graph::test {

enum class Ending { kConfirm, kRefute, kThrow, kNever };

/// A job that comes to a given end after a given number of slices.
class ScriptedJob : public ConfirmationJob {
 public:
  ScriptedJob(Ending ending, int slices, std::chrono::milliseconds per_slice = {})
      : ending_(ending), slices_left_(slices), per_slice_(per_slice) {}

  JobState Run(std::chrono::milliseconds) override {
    if (per_slice_.count() > 0) {
      std::this_thread::sleep_for(per_slice_);
    }
    if (ending_ == Ending::kNever || --slices_left_ > 0) {
      return JobState::kRunning;
    }
    if (ending_ == Ending::kThrow) {
      throw std::runtime_error("solver broke down");
    }
    return ending_ == Ending::kConfirm ? JobState::kConfirmed : JobState::kRefuted;
  }
  std::string reason() const override { return "torque limit"; }

 private:
  Ending ending_;
  int slices_left_;
  std::chrono::milliseconds per_slice_;
};

}  // namespace possibility::graph::test
