#pragma once

#include <filesystem>
#include <vector>

#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// Writes trajectory.csv, contact_forces.csv, units.csv, gains.csv and, if asked for, margins.csv
/// into an existing folder (docs/exports.md), row by row: a table may be larger than memory.
/// Returns the files. @throws InputError if they cannot be written.
std::vector<std::filesystem::path> WriteCsv(const ExportSubject& subject,
                                            const ExportSampling& sampling,
                                            const std::filesystem::path& folder);

}  // namespace possibility::experiments
