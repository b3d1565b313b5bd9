#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Reads DIR/plan.json or a plan file. Resolves paths inside against the plan's folder.
/// @throws InputError naming the file, the key, and what was expected (truncated JSON, another
/// format version, wrong sizes, numbers that are not finite, times out of order within a phase).
Plan ReadPlan(const std::filesystem::path& file_or_directory);

}  // namespace possibility::actions
