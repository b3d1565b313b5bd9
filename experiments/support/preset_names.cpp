#include "experiments/support/preset_names.h"

#include <fmt/format.h>

#include "models/input/input_error.h"

namespace possibility::experiments {

using actions::PlannerPreset;

std::string PresetName(PlannerPreset preset) {
  return preset == PlannerPreset::kPaper ? "paper" : "default";
}

PlannerPreset ParsePreset(const std::string& option, const std::string& text) {
  for (const PlannerPreset preset : {PlannerPreset::kDefault, PlannerPreset::kPaper}) {
    if (PresetName(preset) == text) return preset;
  }
  throw InputError(fmt::format("{}: '{}' is not valid, expected default or paper", option, text));
}

std::vector<PlannerPreset> ParsePresets(const std::string& option, const std::string& text) {
  if (text == "both") return {PlannerPreset::kDefault, PlannerPreset::kPaper};
  try {
    return {ParsePreset(option, text)};
  } catch (const InputError&) {
    throw InputError(
        fmt::format("{}: '{}' is not valid, expected default, paper or both", option, text));
  }
}

}  // namespace possibility::experiments
