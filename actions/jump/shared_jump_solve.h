#pragma once

#include <optional>

#include "actions/jump/jump_library.h"
#include "graph/action/shared_work.h"

namespace possibility::actions {

/// Solves one task for all jobs that need the answer. The library must outlive it.
class SharedJumpSolve {
 public:
  SharedJumpSolve(JumpLibrary* library, const JumpTask& task);

  const JumpTask& task() const { return task_; }

  /// For jobs: waits for the answer. None if the job is cancelled.
  /// @throws as JumpLibrary::FindOrSolve.
  std::optional<JumpAnswer> Await(graph::JobControl* control);

 private:
  JumpTask task_;
  std::optional<JumpAnswer> answer_;
  graph::SharedWork solve_;  ///< sets the answer; ends before what it uses
};

}  // namespace possibility::actions
