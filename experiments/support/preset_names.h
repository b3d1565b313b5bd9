#pragma once

#include <string>
#include <vector>

#include "actions/planner/planner_switches.h"

namespace possibility::experiments {

/// "default" or "paper".
std::string PresetName(actions::PlannerPreset preset);

/// @throws InputError naming the option unless `text` is a preset's name.
actions::PlannerPreset ParsePreset(const std::string& option, const std::string& text);

/// The same; "both" stands for both, the default first.
std::vector<actions::PlannerPreset> ParsePresets(const std::string& option,
                                                 const std::string& text);

}  // namespace possibility::experiments
