#pragma once

#include <string>

namespace possibility::experiments {

/// Colour of an action, "#rrggbb": a gait, a jump, a transition ("a->b"), or, for an empty name,
/// what the pelvis alone reaches. The same in pictures and on pages.
std::string ActionColor(const std::string& action);

}  // namespace possibility::experiments
