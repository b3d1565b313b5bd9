#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collocation/multipliers.h"
#include "collocation/optimal_control_problem.h"
#include "collocation/transcription.h"

namespace possibility::collocation {

/// A solution with the names of what it moves: where the solve of the same or of a neighbouring
/// problem can start.
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

/// JSON ("possibility-solution/1"); every number reads back to the same bits.
/// @throws std::invalid_argument if a number is not finite, InputError if the file cannot be
/// written.
void WriteSolution(const std::filesystem::path& file, const StoredSolution& solution);

/// @throws InputError, one line that names the file and the place in it, for whatever
/// WriteSolution could not have written.
StoredSolution ReadSolution(const std::filesystem::path& file);

}  // namespace possibility::collocation
