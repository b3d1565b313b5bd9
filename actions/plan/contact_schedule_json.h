#pragma once

#include "models/input/json_cursor.h"
#include "models/input/json_text.h"
#include "models/robot/contact_schedule.h"

namespace possibility::actions {

/// The schedule as it stands in plan files (docs/file_formats.md).
/// @throws std::invalid_argument if a number is not finite.
nlohmann::ordered_json ToJson(const models::ContactSchedule& schedule);

/// Inverse of ToJson up to rounding. @throws InputError with file and path.
models::ContactSchedule ReadContactSchedule(const models::JsonCursor& cursor);

}  // namespace possibility::actions
