#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/transcription/multipliers.h"
#include "collocation/transcription/transcription.h"

namespace possibility::collocation {

/// A solution with the names of its quantities: a starting point for a solve of the same or a
/// neighbouring problem.
struct StoredSolution {
  std::string problem;
  std::vector<PhaseNames> phases;
  std::vector<std::string> parameters;
  Trajectory trajectory;
  Multipliers multipliers;

  std::vector<Mesh> Meshes() const;
};

/// @throws std::invalid_argument naming the first phase, coordinate, control or parameter in which
/// the solution differs from the problem.
void CheckSameQuantities(const OptimalControlProblem& problem, const StoredSolution& solution);
/// Whether CheckSameQuantities finds no difference.
bool HasSameQuantities(const OptimalControlProblem& problem, const StoredSolution& solution);

}  // namespace possibility::collocation
