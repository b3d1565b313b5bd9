#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Writes plan.json. Equal plans give equal bytes. Numbers of the motion are rounded
/// (docs/file_formats.md), so verify the plan that is read back. The file is complete or absent
/// (models::AtomicFile).
/// @throws InputError if the file cannot be written; std::invalid_argument if a number is not
///   finite.
void WritePlan(const Plan& plan, const std::filesystem::path& file);

}  // namespace possibility::actions
