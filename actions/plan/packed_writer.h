#pragma once

#include "actions/plan/packed_phase.h"
#include "actions/plan/plan.h"

namespace possibility::actions {

/// Writes a plan of version 2 (docs/file_formats.md), a ZIP archive, a block at a time. Equal plans
/// give equal bytes. The motion is rounded as RoundToPackedSteps does it; a plan that was rounded
/// before, or read from such a file, reads back to the same bits. Torques may be left out if they
/// are those that CompleteTorques (actions/checks/plan_torques.h) computes. The file is complete or
/// absent (models::AtomicFile).
/// @throws InputError if the file cannot be written; std::invalid_argument if a number is not
/// finite
///   or too large, or the knots of a phase do not fit each other.
void WritePackedPlan(const Plan& plan, const std::filesystem::path& file,
                     PackedTorques torques = PackedTorques::kStored);

/// Whether a file of this name is to be of version 2: it ends in .zip. Otherwise it must end in
/// .json. @throws InputError naming the file.
bool IsPackedPlanName(const std::filesystem::path& file);

/// Writes either version, as the name says; torques are left out of version 2 only. @throws
/// InputError and std::invalid_argument as WritePlan and WritePackedPlan do.
void WritePlanAs(const Plan& plan, const std::filesystem::path& file,
                 PackedTorques torques = PackedTorques::kStored);

}  // namespace possibility::actions
