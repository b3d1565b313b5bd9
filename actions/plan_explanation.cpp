#include "actions/plan_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace possibility::actions {
namespace {

/// The first few, and why.
std::string Listed(const std::vector<Manoeuvre::Refusal>& refusals, const std::string& what) {
  constexpr size_t kAtMost = 3;
  if (refusals.empty()) return {};
  std::string text = fmt::format(" {} {}:", refusals.size(), what);
  for (size_t i = 0; i < std::min(refusals.size(), kAtMost); ++i) {
    const graph::Point& from = refusals[i].edge.from;
    text += fmt::format("{} from ({:.2f}, {:.2f}): {}", i == 0 ? "" : ";", from.x(), from.y(),
                        refusals[i].reason);
  }
  return text + (refusals.size() > kAtMost ? "; ..." : ".");
}

}  // namespace

std::string ExplainBarrier(PlanStatus status, const Barrier& barrier) {
  return fmt::format(
      "{}: the search came within {:.2f} m of a goal, at ({:.2f}, {:.2f}); the way on is closed "
      "by {}.",
      status == PlanStatus::kProvenInfeasible
          ? "no route exists within the scenario's bounds, not even for the pelvis alone"
          : "no route exists that these actions could confirm",
      barrier.distance, barrier.closest.x(), barrier.closest.y(),
      barrier.closed_by.empty() ? "the bounds"
                                : fmt::format("{}", fmt::join(barrier.closed_by, ", ")));
}

std::string ExplainSearch(const std::map<std::string, std::int64_t>& statistics) {
  if (statistics.at("cycles") == 0) return {};
  std::string text = " Tried:";
  for (const auto& [name, count] : statistics) {
    if (count != 0) text += fmt::format(" {} {};", name, count);
  }
  text.back() = '.';
  return text;
}

std::string ExplainManoeuvres(const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                              const FailedJobs& failures) {
  std::string text;
  for (const auto& manoeuvre : manoeuvres) {
    text += Listed(manoeuvre->Refusals(), fmt::format("of '{}' refuted", manoeuvre->name()));
    const auto failed = failures.find(manoeuvre->name());
    if (failed == failures.end()) continue;
    text += Listed(failed->second, fmt::format("jobs of '{}' failed", manoeuvre->name()));
  }
  return text;
}

}  // namespace possibility::actions
