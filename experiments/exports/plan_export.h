#pragma once

#include <filesystem>

#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// Writes the plan in the format that the file's name asks for: .json, possibility-plan/1; .zip,
/// possibility-plan/2, refined (actions::RefinedPlan) unless it is of that format already. All
/// knots are written, whatever the sampling. Format 2 leaves out torques that follow from the rest,
/// unless `sampling` asks for them.
/// @throws InputError if the name has another ending, the file cannot be written, or the plan holds
/// numbers that format 2 cannot.
void WritePlanFile(const ExportSubject& subject, const ExportSampling& sampling,
                   const std::filesystem::path& file);

}  // namespace possibility::experiments
