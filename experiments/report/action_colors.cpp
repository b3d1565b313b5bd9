#include "experiments/report/action_colors.h"

#include <array>
#include <cstddef>
#include <utility>

namespace possibility::experiments {

std::string ActionColor(const std::string& action) {
  static constexpr const char* kPelvis = "#7a8699";
  static constexpr const char* kTransition = "#f08a24";
  /// By a word in the action's name.
  static constexpr std::array<std::pair<const char*, const char*>, 3> kKnown = {
      {{"walk", "#2f9e54"}, {"crawl", "#55b4e6"}, {"jump", "#e0219f"}}};
  /// Shared by all other actions.
  static constexpr std::array<const char*, 4> kOthers = {"#7768d8", "#b8860b", "#0c8599",
                                                         "#74480f"};
  if (action.empty()) return kPelvis;
  if (action.find("->") != std::string::npos) return kTransition;
  for (const auto& [word, color] : kKnown) {
    if (action.find(word) != std::string::npos) return color;
  }
  std::size_t sum = 0;
  for (const char c : action) sum += static_cast<unsigned char>(c);
  return kOthers[sum % kOthers.size()];
}

}  // namespace possibility::experiments
