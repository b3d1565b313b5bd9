#pragma once

#include <filesystem>

#include "experiments/regression/regression_run.h"

namespace possibility::experiments {

/// Writes into an existing folder: NAME.svg for each problem with a motion, and index.html with the
/// table of results and all pictures.
/// @throws InputError naming the file that cannot be written.
void WriteRegressionPages(const RegressionReport& report, const std::filesystem::path& folder);

}  // namespace possibility::experiments
