#include "actions/planner/passage_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace possibility::actions {
namespace {

/// "0.60 m wide, 0.86 needed by 'walk'".
std::string Explain(const PassageNeed& need) {
  if (need.dimension != PassageDimension::kGap) {
    return fmt::format("{:.2f} m {}, {:.2f} needed by '{}'", need.available,
                       need.dimension == PassageDimension::kWidth ? "wide" : "high", need.needed,
                       need.action);
  }
  const std::string gap = fmt::format("{:.2f} m without ground", need.available);
  if (need.action.empty()) return gap;
  return fmt::format("{}, '{}' reaches over {:.2f}", gap, need.action, need.needed);
}

}  // namespace

std::string ExplainPassage(bool has_barrier, const std::optional<NarrowPassage>& passage) {
  if (!passage) return {};
  std::vector<std::string> needs;
  needs.reserve(passage->needs.size());
  for (const PassageNeed& need : passage->needs) needs.push_back(Explain(need));
  const bool is_gap = passage->between == std::vector<std::string>{"no ground"};
  return fmt::format(" {} at ({:.2f}, {:.2f}){}: {}.",
                     has_barrier ? "The narrowest place on the way is"
                                 : "No barrier was found; the narrowest place on the way is",
                     passage->place.x(), passage->place.y(),
                     is_gap || passage->between.empty()
                         ? ""
                         : fmt::format(", {} {}", passage->between.size() > 1 ? "between" : "at",
                                       fmt::join(passage->between, ", ")),
                     fmt::join(needs, "; "));
}

}  // namespace possibility::actions
