#pragma once

#include "collocation/study/stored_solution.h"

namespace possibility::collocation {

/// Reads a file of WriteSolution. @throws InputError, one line that names the file and the place in
/// it, for anything that WriteSolution could not have written.
StoredSolution ReadSolution(const std::filesystem::path& file);

}  // namespace possibility::collocation
