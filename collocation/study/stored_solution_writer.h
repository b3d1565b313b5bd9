#pragma once

#include "collocation/study/stored_solution.h"

namespace possibility::collocation {

/// Writes JSON ("possibility-solution/1"); every number reads back to the same bits.
/// @throws std::invalid_argument if a number is not finite, InputError if the file cannot be
/// written.
void WriteSolution(const std::filesystem::path& file, const StoredSolution& solution);

}  // namespace possibility::collocation
