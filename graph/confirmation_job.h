#pragma once

#include <chrono>
#include <string>

namespace possibility::graph {

enum class JobState {
  kRunning,    ///< undecided: run another slice
  kConfirmed,  ///< the edge is possible
  kRefuted,    ///< the edge is impossible
};

/// A resumable routine that examines one edge (paper: SpawnConfirmationJob). The queue gives it
/// slices of time in rotation, on one worker thread at a time.
class ConfirmationJob {
 public:
  virtual ~ConfirmationJob() = default;

  /// Works for about `slice` and returns. May throw: that refutes nothing, the edge is set aside.
  virtual JobState Run(std::chrono::milliseconds slice) = 0;

  /// Why the job was refuted, for people; empty otherwise.
  virtual std::string reason() const { return {}; }
};

}  // namespace possibility::graph
