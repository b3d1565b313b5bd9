#include "actions/route/island_explorer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

constexpr std::int64_t kIslandStancesPerTurn = 250;
constexpr std::int64_t kCrossingStatesPerTurn = 50;
constexpr std::int64_t kStates = 4000;  // of one crossing

/// Of one island.
constexpr LatticeSettings kLattice = {
    .step = 0.4, .headings = 8, .greed = 2, .most_stances = 10000};
constexpr int kMostIslands = 400;  // in all
constexpr int kMostIslandProposals = 40;

/// Stances beyond the island: so far from each other, in so many headings.
constexpr double kSpacing = 0.2;      // m, more where there would be too many places
constexpr double kMostPlaces = 2500;  // on each level
constexpr int kHeadings = 4;
/// A stance is beyond the island if nothing reached is so near, m, and straight ways from what is
/// reached up to kBeside away do not meet C_S.
constexpr double kBeyond = 0.3;
constexpr double kBeside = 0.9;
constexpr double kSameLevel = 1e-3;  // m

/// More than steps take, so that steps lead on as far as they can.
constexpr double kSecondsPerMetreLeft = 3;
constexpr double kSecondsPerRadianLeft = 3;

}  // namespace

IslandExplorer::IslandExplorer(const RouteSpace& lattice, const PlannedSteps& steps, int action,
                               const GroundedStance& start,
                               const std::vector<GroundedStance>& goals, const bool* is_called,
                               const bool* is_alone, const graph::ExplorerContext& context)
    : lattice_(lattice),
      steps_(steps),
      action_(action),
      goals_(goals),
      is_called_(is_called),
      is_alone_(is_alone),
      deadline_(context.deadline),
      islands_(&(*context.counters)["footsteps: islands"]),
      states_(&(*context.counters)["footsteps: states"]),
      start_(start),
      entry_(start) {}

graph::Findings IslandExplorer::Explore() {
  if (is_over_) return {graph::Outlook::kOver, {}};
  const CancellationToken cancellation(*deadline_);
  try {
    return crossing_ ? LeaveIsland(cancellation) : ExploreIsland(cancellation);
  } catch (const Cancelled&) {
    return {graph::Outlook::kOver, {}};
  }
}

graph::Findings IslandExplorer::ExploreIsland(const CancellationToken& cancellation) {
  if (!island_) {
    ++*islands_;
    island_ = std::make_unique<LatticeSearch>(lattice_, entry_, goals_, kLattice);
  }
  switch (island_->Advance(kIslandStancesPerTurn, cancellation)) {
    case LatticeSearch::Status::kSearching:
      return {graph::Outlook::kLeadsOn, {}};
    case LatticeSearch::Status::kGivenUp:
      Remember();
      if (BeginToLeave(cancellation)) return {graph::Outlook::kLeadsOn, {}};
      return GoBack(cancellation);
    case LatticeSearch::Status::kFound:
      break;
  }
  is_over_ = true;
  ++proposals_;
  std::vector<graph::PathEdge> route = route_;
  for (graph::PathEdge& edge : island_->Route()) route.push_back(std::move(edge));
  return {graph::Outlook::kOver, std::move(route)};
}

/// What was refuted is known to the actions.
bool IslandExplorer::OnRefuted() {
  if (!is_over_ || proposals_ == 0 || proposals_ >= kMostIslandProposals) return false;
  is_over_ = false;
  entry_ = start_;
  route_.clear();
  reached_.clear();
  earlier_.clear();
  island_.reset();
  crossing_.reset();
  return true;
}

void IslandExplorer::Remember() {
  const std::vector<GroundedStance> reached = island_->Reached();
  reached_.insert(reached_.end(), reached.begin(), reached.end());
}

/// Stances beyond an island are none that were reached from any other, so every island is left in
/// vain only once.
graph::Findings IslandExplorer::GoBack(const CancellationToken& cancellation) {
  crossing_.reset();
  while (!earlier_.empty()) {
    entry_ = earlier_.back().entry;
    island_ = std::move(earlier_.back().island);
    route_.erase(route_.begin() + earlier_.back().edges, route_.end());
    earlier_.pop_back();
    if (BeginToLeave(cancellation)) return {graph::Outlook::kLeadsOn, {}};
  }
  is_over_ = true;
  return {graph::Outlook::kOver, {}};
}

/// @returns false if there is nowhere to go.
bool IslandExplorer::BeginToLeave(const CancellationToken& cancellation) {
  FootstepEnds ends;
  const std::vector<GroundedStance> reached = island_->Reached();
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i].gait != steps_.from()) continue;
    ends.starts.push_back(reached[i]);
    ends.start_times.push_back(island_->TimeTo(static_cast<int>(i)));
  }
  if (ends.starts.empty() || *islands_ >= kMostIslands) return false;
  beyond_ = StancesBeyond(cancellation);
  if (!island_->IsThrough()) KeepNearer(reached);
  DropUnreachable(ends.starts, cancellation);
  if (beyond_.empty()) return false;
  ends.goals = beyond_;
  for (const GroundedStance& stance : beyond_) ends.goal_times.push_back(TimeLeft(stance));
  crossing_.emplace(*lattice_.model, steps_.from(), gait().world(), std::move(ends),
                    steps_.limits(), steps_.known_ground(), cancellation);
  crossing_->most_states = kStates << steps_.doublings();
  return true;
}

graph::Findings IslandExplorer::LeaveIsland(const CancellationToken& cancellation) {
  const std::int64_t before = crossing_->states();
  const FootstepSearch::Status status = crossing_->Advance(kCrossingStatesPerTurn, cancellation);
  *states_ += crossing_->states() - before;
  if (status == FootstepSearch::Status::kSearching) return {graph::Outlook::kLeadsOn, {}};
  if (status == FootstepSearch::Status::kExhausted) return GoBack(cancellation);
  return CrossTo(crossing_->start(), beyond_[crossing_->goal()]);
}

/// The next island begins there.
graph::Findings IslandExplorer::CrossTo(const GroundedStance& from, const GroundedStance& to) {
  const std::vector<GroundedStance> reached = island_->Reached();
  const auto edges = static_cast<std::ptrdiff_t>(route_.size());
  const auto exit = std::find_if(reached.begin(), reached.end(), [&](const GroundedStance& other) {
    return other.gait == from.gait && other.z == from.z &&
           other.pose.position() == from.pose.position() && other.pose.yaw == from.pose.yaw;
  });
  for (graph::PathEdge& edge : island_->RouteTo(static_cast<int>(exit - reached.begin()))) {
    route_.push_back(std::move(edge));
  }
  const NominalStance& stance = lattice_.model->gaits[steps_.from()]->stance;
  const graph::Edge edge{ToPoint(stance.RootPose(from.pose, from.z)),
                         ToPoint(stance.RootPose(to.pose, to.z))};
  steps_.Suggest(edge, crossing_->steps());
  route_.push_back({action_, edge});
  earlier_.push_back({entry_, std::move(island_), edges});
  entry_ = to;
  crossing_.reset();
  return {graph::Outlook::kLeadsOn, {}};
}

std::vector<GroundedStance> IslandExplorer::StancesBeyond(
    const CancellationToken& cancellation) const {
  std::vector<GroundedStance> beyond;
  const Eigen::AlignedBox2d& bounds = gait().world().environment->bounds;
  const double spacing = std::max(kSpacing, std::sqrt(bounds.sizes().prod() / kMostPlaces));
  GroundedStance stance;
  stance.gait = steps_.from();
  const auto offer = [&] {
    if (!IsKnown(stance) && gait().Examine(stance) == StanceFault::kNone) beyond.push_back(stance);
  };
  for (const double z : gait().world().ground->levels()) {
    stance.z = z;
    for (double x = bounds.min().x(); x <= bounds.max().x(); x += spacing) {
      cancellation.ThrowIfCancelled();
      for (double y = bounds.min().y(); y <= bounds.max().y(); y += spacing) {
        for (int heading = 0; heading < kHeadings; ++heading) {
          stance.pose = {x, y, 2 * std::numbers::pi / kHeadings * heading};
          offer();
        }
      }
    }
  }
  for (const GroundedStance& goal : goals_) {
    if (goal.gait != steps_.from()) continue;
    stance = goal;
    offer();
  }
  return beyond;
}

/// Of an island too large to be explored, much of what seems beyond it is not.
void IslandExplorer::KeepNearer(const std::vector<GroundedStance>& reached) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const GroundedStance& stance : reached) nearest = std::min(nearest, TimeLeft(stance));
  std::erase_if(beyond_, [&](const GroundedStance& stance) { return TimeLeft(stance) >= nearest; });
}

/// The search for steps heads for the best stance beyond: in vain if steps cannot lead there.
void IslandExplorer::DropUnreachable(const std::vector<GroundedStance>& starts,
                                     const CancellationToken& cancellation) {
  const World& world = gait().world();
  const NominalStance& stance = lattice_.model->gaits[steps_.from()]->stance;
  if (beyond_.empty() || world.environment->bounds.isEmpty() || !StandsOnTwoSoles(*stance.gait)) {
    return;
  }
  if (flood_) {
    flood_->Restart(starts, cancellation);
  } else {
    flood_.emplace(stance, world, GentlePlanes(*lattice_.model->robot, *world.ground),
                   steps_.limits(), starts, cancellation);
  }
  std::erase_if(beyond_, [&](const GroundedStance& stance) { return !flood_->Reaches(stance); });
}

bool IslandExplorer::IsKnown(const GroundedStance& stance) const {
  return std::any_of(reached_.begin(), reached_.end(), [&](const GroundedStance& other) {
    if (std::abs(other.z - stance.z) > kSameLevel) return false;
    const double distance = (other.pose.position() - stance.pose.position()).norm();
    if (distance < kBeyond) return true;
    return distance < kBeside && other.gait == stance.gait && gait().CS(other, stance);
  });
}

double IslandExplorer::TimeLeft(const GroundedStance& stance) const {
  double least = std::numeric_limits<double>::infinity();
  for (const GroundedStance& goal : goals_) {
    const double distance = (goal.pose.position() - stance.pose.position()).norm();
    const double turn = std::abs(WrapAngle(goal.pose.yaw - stance.pose.yaw));
    least = std::min(least, kSecondsPerMetreLeft * (distance + std::abs(goal.z - stance.z)) +
                                kSecondsPerRadianLeft * turn);
  }
  return least;
}

graph::ExplorerFactory IslandExploration(const RouteSpace& lattice, const PlannedSteps& steps,
                                         int action, const GroundedStance& start,
                                         const std::vector<GroundedStance>& goals,
                                         const bool* is_called, const bool* is_alone) {
  return [=, &steps](const graph::ExplorerContext& context) {
    return std::make_unique<IslandExplorer>(lattice, steps, action, start, goals, is_called,
                                            is_alone, context);
  };
}

}  // namespace possibility::actions
