#pragma once

#include <filesystem>

#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// Writes a recording for Foxglove and other readers of MCAP (docs/exports.md): the scene, the
/// robot and its URDF once; transforms, joint states and contact forces at every sample.
///
/// Without a period the samples are 0.02 s apart. @throws InputError if the file cannot be written,
/// or the robot's URDF not be read.
void WriteMcap(const ExportSubject& subject, const ExportSampling& sampling,
               const std::filesystem::path& file);

}  // namespace possibility::experiments
