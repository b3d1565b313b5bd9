#include "actions/jump/shared_jump_solve.h"

#include <cstdint>

namespace possibility::actions {
namespace {

/// An iteration of a jump takes about 25 ms on our machines, as long as several checkpoints of
/// other work. A jump that does not fit into one turn of 1000 checkpoints is a difficult one
/// (median: 54 iterations).
constexpr std::int64_t kCheckpointsPerIteration = 10;

}  // namespace

SharedJumpSolve::SharedJumpSolve(JumpLibrary* library, const JumpTask& task)
    : task_(task), solve_([this, library](graph::SharedWork* self) {
        answer_ =
            library->FindOrSolve(task_, self->token(), [self](const collocation::SolverIteration&) {
              self->Charge(kCheckpointsPerIteration);
            });
      }) {}

std::optional<JumpAnswer> SharedJumpSolve::Await(graph::JobControl* control) {
  return solve_.Await(control) ? answer_ : std::nullopt;
}

}  // namespace possibility::actions
