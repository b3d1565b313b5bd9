#include "actions/route/lattice_explorer.h"

#include <limits>
#include <memory>

#include "actions/route/shortcuts.h"

namespace possibility::actions {
namespace {

/// Stances examined per turn: a few microseconds each, more with manoeuvres.
constexpr std::int64_t kStancesPerTurn = 500;

/// Turns without progress towards a goal after which a search shares its time with other explorers.
constexpr int kPatientTurns = 8;

/// Largest number of refuted routes that are replaced.
constexpr int kMostProposals = 8;

/// Few passes: the ShortcutExplorer finds the rest.
constexpr int kShortcutPasses = 2;

/// Required gain of a quicker route, as a fraction of the known duration.
constexpr double kWorthwhileGain = 0.02;

}  // namespace

std::span<const LatticeSettings> FirstRouteLadder() {
  static constexpr LatticeSettings kLadder[] = {
      {.step = 0.8, .headings = 1, .greed = 3, .most_stances = 20000},
      {.step = 0.8, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.4, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.2, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.2, .headings = 16, .greed = 4, .most_stances = 20000}};
  return kLadder;
}

std::span<const LatticeSettings> ImprovementLadder() {
  static constexpr LatticeSettings kLadder[] = {
      {.step = 0.8, .headings = 8, .greed = 1, .most_stances = 20000},
      {.step = 0.4, .headings = 8, .greed = 1, .most_stances = 40000}};
  return kLadder;
}

LatticeExplorer::LatticeExplorer(const RouteSpace& space, const GroundedStance& start,
                                 const std::vector<GroundedStance>& goals,
                                 const graph::ExplorerContext& context)
    : space_(space),
      start_(start),
      goals_(goals),
      deadline_(context.deadline),
      ladder_(FirstRouteLadder()) {}

graph::Findings LatticeExplorer::Explore() {
  if (rung_ == ladder_.size()) return {graph::Outlook::kOver, {}};
  if (!search_) {
    search_.emplace(space_, start_, goals_, ladder_[rung_]);
    if (bound_ > 0) search_->SetBound(bound_);
    closest_ = std::numeric_limits<double>::infinity();
    turns_without_progress_ = 0;
  }
  switch (search_->Advance(kStancesPerTurn, CancellationToken(*deadline_))) {
    case LatticeSearch::Status::kFound:
      return Propose();
    case LatticeSearch::Status::kGivenUp:
      return NextLattice();
    case LatticeSearch::Status::kSearching:
      break;
  }
  return {OutlookOfSearch(), {}};
}

/// A refuted first route is replaced by another on the same lattice. With a greed of 1 no quicker
/// one exists there. A route that is not quicker may become so once shortened.
graph::Findings LatticeExplorer::Propose() {
  graph::Findings findings{graph::Outlook::kOver, search_->Route()};
  ++proposals_;
  if (bound_ == 0) {
    search_.reset();
    return findings;
  }
  for (int pass = 0; pass < kShortcutPasses; ++pass) {
    findings.route = FindShortcuts(space_, findings.route, goals_, CancellationToken(*deadline_));
  }
  findings.outlook = NextLattice().outlook;
  return findings;
}

graph::Findings LatticeExplorer::NextLattice() {
  if (bound_ > 0) lower_bound_ = search_->LowerBound();
  search_.reset();
  ++rung_;
  return {rung_ == ladder_.size() ? graph::Outlook::kOver : graph::Outlook::kLeadsOn, {}};
}

graph::Outlook LatticeExplorer::OutlookOfSearch() {
  if (search_->closest_approach() < closest_) {
    closest_ = search_->closest_approach();
    turns_without_progress_ = 0;
  } else {
    ++turns_without_progress_;
  }
  return turns_without_progress_ < kPatientTurns ? graph::Outlook::kLeadsOn : graph::Outlook::kOpen;
}

bool LatticeExplorer::OnRefuted() { return rung_ < ladder_.size() && proposals_ < kMostProposals; }

bool LatticeExplorer::OnRoute(const std::vector<graph::PathEdge>&, double duration) {
  if (bound_ == 0) {
    ladder_ = ImprovementLadder();
    rung_ = 0;
    proposals_ = 0;
    search_.reset();
  }
  bound_ = (1 - kWorthwhileGain) * duration;
  if (search_) search_->SetBound(bound_);
  return rung_ < ladder_.size() && proposals_ < kMostProposals;
}

graph::ExplorerFactory LatticeExploration(const RouteSpace& space, const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals) {
  return [=](const graph::ExplorerContext& context) {
    return std::make_unique<LatticeExplorer>(space, start, goals, context);
  };
}

}  // namespace possibility::actions
