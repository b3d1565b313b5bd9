#include "actions/route/shortcut_explorer.h"

#include <memory>
#include <utility>

#include "actions/route/shortcuts.h"

namespace possibility::actions {
namespace {

/// Least gain in duration that is not rounding, s.
constexpr double kQuicker = 1e-6;

}  // namespace

ShortcutExplorer::ShortcutExplorer(const RouteSpace& space,
                                   const std::vector<GroundedStance>& goals,
                                   const graph::ExplorerContext& context)
    : space_(space), goals_(goals), context_(context) {}

graph::Findings ShortcutExplorer::Explore() {
  if (route_.empty()) return {graph::Outlook::kOver, {}};
  const std::vector<graph::PathEdge> known = std::exchange(route_, {});
  std::vector<graph::PathEdge> quicker =
      FindShortcuts(space_, known, goals_, CancellationToken(*context_.deadline));
  if (DurationOf(quicker) >= DurationOf(known) - kQuicker) quicker.clear();
  return {graph::Outlook::kOver, std::move(quicker)};
}

bool ShortcutExplorer::OnRoute(const std::vector<graph::PathEdge>& route, double) {
  route_ = route;
  return !route_.empty();
}

double ShortcutExplorer::DurationOf(const std::vector<graph::PathEdge>& route) const {
  double duration = 0;
  for (const graph::PathEdge& edge : route) {
    duration += (*context_.actions)[edge.action]->ExpectedDuration(edge.points);
  }
  return duration;
}

graph::ExplorerFactory ShortcutExploration(const RouteSpace& space,
                                           const std::vector<GroundedStance>& goals) {
  return [=](const graph::ExplorerContext& context) {
    return std::make_unique<ShortcutExplorer>(space, goals, context);
  };
}

}  // namespace possibility::actions
