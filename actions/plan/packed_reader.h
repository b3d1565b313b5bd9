#pragma once

#include <string_view>

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Reads the bytes of a plan of version 2, a block at a time. `file`: for messages, and paths in
/// the plan are resolved against its folder. @throws InputError naming the file and the key or
/// member.
Plan ReadPackedPlan(std::string_view bytes, const std::filesystem::path& file);

}  // namespace possibility::actions
