#pragma once

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {

/// A block of 1 kg, moved by 1 m from rest to rest by a force. The cost is the test's.
struct MovedBlock {
  explicit MovedBlock(Bounds duration)
      : problem("block"),
        move(problem.AddPhase("move", 2)),
        x(move.AddCoordinate("x")),
        u(move.AddControl("force")) {
    move.SetDuration(duration);
    move.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
    for (const At end : {At::kStart, At::kEnd}) move.Fix(move.Rate(x), 0, end);
    move.Fix(x, 0, At::kStart);
    move.Fix(x, 1, At::kEnd);
  }

  OptimalControlResult Solve(const TranscriptionScheme& scheme, const Mesh& mesh) const {
    OptimalControlOptions options;
    options.scheme = scheme;
    options.meshes = {mesh};
    options.solver.tolerance = 1e-11;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem;
  Phase& move;
  Variable x, u;
};

}  // namespace possibility::collocation
