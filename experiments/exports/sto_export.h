#pragma once

#include <filesystem>

#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// Writes a storage of OpenSim (docs/exports.md): coordinates and speeds, joint torques, and the
/// force of the ground on every patch with its centre of pressure and free moment.
///
/// Without a period the rows are 0.01 s apart. @throws InputError if the file cannot be written.
void WriteSto(const ExportSubject& subject, const ExportSampling& sampling,
              const std::filesystem::path& file);

}  // namespace possibility::experiments
