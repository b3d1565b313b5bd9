#pragma once

#include "collocation/study/stored_solution.h"

namespace possibility::collocation {

/// @throws InputError, one line that names the file and the place in it, for whatever
/// WriteSolution could not have written.
StoredSolution ReadSolution(const std::filesystem::path& file);

}  // namespace possibility::collocation
