#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "experiments/formats/npy_array.h"
#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// Name of the layout of the arrays (docs/exports.md).
inline constexpr const char* kTrajectoryFormat = "possibility-trajectory/1";

/// The arrays of an .npz file, by name.
std::map<std::string, NpyArray> TrajectoryArrays(const ExportSubject& subject,
                                                 const ExportSampling& sampling);

/// Writes them. @throws InputError if the file cannot be written or would exceed 4 GiB.
void WriteNpz(const ExportSubject& subject, const ExportSampling& sampling,
              const std::filesystem::path& file);

}  // namespace possibility::experiments
