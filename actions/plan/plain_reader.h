#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Reads the text of a plan of version 1. `file`: for messages, and paths in the text are resolved
/// against its folder. @throws InputError with file and path.
Plan ReadPlainPlan(const std::string& text, const std::filesystem::path& file);

}  // namespace possibility::actions
