#include "graph/search/exploration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace possibility::graph {
namespace {

/// Sanitizers and busy machines stay below this factor, so a search that keeps to its budgets does
/// not depend on the clock.
constexpr double kToleratedSlowness = 10;

}  // namespace

Exploration::Exploration(const ExplorerContext& context,
                         const std::vector<ExplorerFactory>& explorers,
                         PathConfirmation* confirmation)
    : context_(context), confirmation_(confirmation) {
  for (const ExplorerFactory& make : explorers) {
    seats_.push_back({make(context), Outlook::kOpen});
  }
}

void Exploration::Explore(SearchStage stage) {
  for (Seat& seat : seats_) {
    if (!IsWaiting(seat, stage)) {
      continue;
    }
    TakeTurn(&seat);
    if (seat.outlook != Outlook::kOpen || context_.deadline->Passed()) {
      return;
    }
  }
}

void Exploration::TakeTurn(Seat* seat) {
  const double begin = context_.deadline->Elapsed();
  const Findings findings = seat->explorer->Explore();
  measured_ += context_.deadline->Elapsed() - begin;
  declared_ += seat->explorer->work_of_turn();
  seat->outlook = findings.outlook;
  LabelNewEdges(seat->explorer->name());
  AppendRoute(findings.route, seat->explorer->name());
}

bool Exploration::IsWaiting(const Seat& seat, SearchStage stage) const {
  return seat.outlook != Outlook::kOver && seat.explorer->TakesPart(stage);
}

bool Exploration::IsOver(SearchStage stage) const {
  return std::none_of(seats_.begin(), seats_.end(),
                      [&](const Seat& seat) { return IsWaiting(seat, stage); });
}

bool Exploration::SomebodyIsThrough(SearchStage stage) const {
  return std::any_of(seats_.begin(), seats_.end(), [&](const Seat& seat) {
    return seat.outlook == Outlook::kOver && seat.explorer->TakesPart(stage);
  });
}

void Exploration::OnRefuted() {
  for (Seat& seat : seats_) {
    if (seat.explorer->OnRefuted()) {
      seat.outlook = Outlook::kOpen;
    }
  }
}

void Exploration::OnUndecided() {
  for (Seat& seat : seats_) seat.explorer->OnUndecided();
}

void Exploration::OnRoute(const std::vector<PathEdge>& route, double duration) {
  for (Seat& seat : seats_) {
    if (seat.explorer->OnRoute(route, duration)) {
      seat.outlook = Outlook::kOpen;
    }
  }
}

void Exploration::AppendRoute(const std::vector<PathEdge>& route, const std::string& found_by) {
  if (route.empty()) {
    return;
  }
  VertexId v = context_.master->VertexAt(route.front().points.from);
  for (const PathEdge& step : route) {
    const VertexId next = context_.master->VertexAt(step.points.to);
    if (next != v && !AppendEdge(step.action, v, next)) {
      break;
    }
    v = next;
  }
  LabelNewEdges(found_by);
}

bool Exploration::AppendEdge(int a, VertexId from, VertexId to) {
  PossibilityGraph& master = *context_.master;
  const Action& action = *(*context_.actions)[a];
  if (const auto known = master.FindEdge(a, from, to);
      known && master.possibility(*known) == Possibility::kPossible) {
    return true;
  }
  const Edge points = {master.point(from), master.point(to)};
  const bool is_sure = action.CS(points);
  if (!is_sure && !(action.Explorable(points.to) && action.Explorable(points))) {
    return false;
  }
  const Discovery found = {
      a, {.vertices = {to}, .edges = {{from, to, action.IsReversible()}}, .offered = {to}}};
  for (Seat& seat : seats_) {
    seat.explorer->TakeOver(found);
  }
  master.Append(a, found.elements.edges);
  if (is_sure) {
    confirmation_->OnSufficientConditions(a, from, to);
  }
  return true;
}

void Exploration::LabelNewEdges(const std::string& name) {
  const std::size_t num_edges = context_.master->topology().num_edges();
  if (found_by_.size() == num_edges) {
    return;
  }
  const auto known = std::find(names_.begin(), names_.end(), name);
  const auto label = static_cast<int>(known - names_.begin());
  if (known == names_.end()) {
    names_.push_back(name);
  }
  found_by_.resize(num_edges, label);
}

double Exploration::work() const {
  return measured_ > kToleratedSlowness * declared_ ? measured_ : declared_;
}

double Exploration::lower_bound() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Seat& seat : seats_) {
    const double bound = seat.explorer->lower_bound();
    if (bound > 0) {
      least = std::min(least, bound);
    }
  }
  return std::isfinite(least) ? least : 0;
}

}  // namespace possibility::graph
