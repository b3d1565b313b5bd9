#pragma once

#include "actions/plan/contact_schedule.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::actions {

/// The schedule as it stands in plan files (docs/file_formats.md).
/// @throws std::invalid_argument if a number is not finite.
nlohmann::ordered_json ToJson(const ContactSchedule& schedule);

/// Inverse of ToJson up to rounding. @throws InputError with file and path.
ContactSchedule ReadContactSchedule(const models::JsonCursor& cursor);

}  // namespace possibility::actions
