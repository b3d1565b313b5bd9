#include "actions/route/step_shortcut_explorer.h"

#include <memory>

#include "actions/route/route.h"

namespace possibility::actions {
namespace {

constexpr std::int64_t kStretchStatesPerTurn = 50;
constexpr std::int64_t kMostStretchStates = 1000;  // of one stretch

std::vector<double> EndsOf(const graph::Edge& edge) {
  std::vector<double> numbers(edge.from.data(), edge.from.data() + edge.from.size());
  numbers.insert(numbers.end(), edge.to.data(), edge.to.data() + edge.to.size());
  return numbers;
}

}  // namespace

StepShortcutExplorer::StepShortcutExplorer(const RouteSpace& space, const PlannedSteps& steps,
                                           int action, const bool* is_called,
                                           const graph::ExplorerContext& context)
    : space_(space), steps_(steps), action_(action), is_called_(is_called), context_(context) {}

graph::Findings StepShortcutExplorer::Explore() {
  if (stretches_.empty()) return {graph::Outlook::kOver, {}};
  std::vector<graph::PathEdge> found;
  try {
    found = Continue(CancellationToken(*context_.deadline));
  } catch (const Cancelled&) {
    return {graph::Outlook::kOver, {}};
  }
  if (!search_) {
    tried_.insert(EndsOf(stretches_.front().edge));
    stretches_.pop_front();
  }
  return {stretches_.empty() ? graph::Outlook::kOver : graph::Outlook::kLeadsOn, std::move(found)};
}

/// One turn on the first stretch. Without `search_` it is done.
std::vector<graph::PathEdge> StepShortcutExplorer::Continue(const CancellationToken& cancellation) {
  const Stretch& stretch = stretches_.front();
  if (!search_) {
    const World& world = (*space_.gaits)[steps_.from()]->world();
    search_.emplace(*space_.model, steps_.from(), world,
                    FootstepEnds{{stretch.from}, {stretch.to}, {}, {}}, steps_.limits(),
                    steps_.known_ground(), cancellation);
    search_->most_states = kMostStretchStates;
  }
  const FootstepSearch::Status status = search_->Advance(kStretchStatesPerTurn, cancellation);
  if (status == FootstepSearch::Status::kSearching) return {};
  const std::vector<Footstep> steps =
      status == FootstepSearch::Status::kFound ? search_->steps() : std::vector<Footstep>();
  search_.reset();
  const bool is_quicker = !steps.empty() && steps_.ExpectedDuration(steps) < stretch.duration;

  if (!is_quicker) return {};
  steps_.Suggest(stretch.edge, steps, stretch.duration);
  return {{action_, stretch.edge}};
}

bool StepShortcutExplorer::OnRoute(const std::vector<graph::PathEdge>& route, double) {
  search_.reset();
  stretches_.clear();
  for (Stretch& stretch : StretchesOf(route)) {
    if (tried_.count(EndsOf(stretch.edge)) == 0) stretches_.push_back(std::move(stretch));
  }
  return !stretches_.empty();
}

/// Of every chain of manoeuvres between stances of the gait: the whole chain, then its halves and
/// so on. A manoeuvre through another gait is part of a chain with what leads back.
std::vector<StepShortcutExplorer::Stretch> StepShortcutExplorer::StretchesOf(
    const std::vector<graph::PathEdge>& route) const {
  std::vector<Stretch> stretches;
  std::vector<Stretch> chain;
  std::optional<Stretch> link;
  const Route legs = RouteAlong(*space_.model, *space_.manoeuvres, route);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const RouteLeg& leg = legs[i];
    const bool is_manoeuvre = leg.manoeuvre != nullptr && route[i].action != action_;
    if (!link && is_manoeuvre && StartGait(*space_.model, leg) == steps_.from()) {
      link = Stretch{{steps_.from(), leg.from, leg.z}, {}, {route[i].points.from, {}}, 0};
    }
    if (!link) {
      AddParts(std::exchange(chain, {}), &stretches);
      continue;
    }
    link->duration += (*context_.actions)[route[i].action]->ExpectedDuration(route[i].points);
    if (EndGait(*space_.model, leg) != steps_.from()) continue;
    link->to = {steps_.from(), leg.to, leg.z_to};
    link->edge.to = route[i].points.to;
    chain.push_back(*std::exchange(link, {}));
  }
  AddParts(chain, &stretches);
  return stretches;
}

void StepShortcutExplorer::AddParts(const std::vector<Stretch>& chain,
                                    std::vector<Stretch>* stretches) {
  if (chain.empty()) return;
  Stretch whole = chain.front();
  whole.to = chain.back().to;
  whole.edge.to = chain.back().edge.to;
  for (std::size_t i = 1; i < chain.size(); ++i) whole.duration += chain[i].duration;
  stretches->push_back(whole);
  if (chain.size() == 1) return;
  const auto middle = chain.begin() + static_cast<std::ptrdiff_t>(chain.size() / 2);
  AddParts({chain.begin(), middle}, stretches);
  AddParts({middle, chain.end()}, stretches);
}

graph::ExplorerFactory StepShortcutExploration(const RouteSpace& space, const PlannedSteps& steps,
                                               int action, const bool* is_called) {
  return [=, &steps](const graph::ExplorerContext& context) {
    return std::make_unique<StepShortcutExplorer>(space, steps, action, is_called, context);
  };
}

}  // namespace possibility::actions
