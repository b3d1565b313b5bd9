#include "actions/route/footstep_explorer.h"

#include <cmath>
#include <limits>
#include <memory>

#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

constexpr std::int64_t kStatesPerTurn = 50;
/// Where the search has neither found steps nor a proof that there are none, it goes on beside the
/// islands, with twice as many states each time, up to so many (PlannedSteps::doublings: twice).
constexpr std::int64_t kMostStates = 16000;

/// Of a manoeuvre of planned steps, s: coming to rest and starting again.
constexpr double kStop = 2.5;

constexpr double kArrived = 1e-9;  // m and rad

}  // namespace

FootstepExplorer::FootstepExplorer(const RouteSpace& space, const PlannedSteps& steps, int action,
                                   const GroundedStance& start,
                                   const std::vector<GroundedStance>& goals, const bool* is_called,
                                   bool* gave_up, const graph::ExplorerContext& context)
    : space_(space),
      steps_(steps),
      action_(action),
      start_(start),
      goals_(goals),
      is_called_(is_called),
      gave_up_(gave_up),
      deadline_(context.deadline),
      states_(&(*context.counters)["footsteps: states"]) {}

graph::Findings FootstepExplorer::Explore() {
  if (proposals_ == 1) {
    ++proposals_;
    return {graph::Outlook::kOver, WholeWay()};
  }
  if (proposals_ > 1) return {graph::Outlook::kOver, {}};
  const CancellationToken cancellation(*deadline_);
  try {
    if (!search_) {
      search_.emplace(*space_.model, start_.gait, gait().world(),
                      FootstepEnds{{start_}, goals_, {}, {}}, steps_.limits(),
                      steps_.known_ground(), cancellation);
    }
    const FootstepSearch::Status status = search_->Advance(kStatesPerTurn, cancellation);
    *states_ = search_->states();
    if (status == FootstepSearch::Status::kSearching) return {graph::Outlook::kLeadsOn, {}};
    if (status == FootstepSearch::Status::kExhausted) {
      *gave_up_ = true;
      if (MayGoOn()) return {graph::Outlook::kLeadsOn, {}};
      proposals_ = 2;
      return {graph::Outlook::kOver, {}};
    }
  } catch (const Cancelled&) {
    return {graph::Outlook::kOver, {}};
  }
  ++proposals_;
  return {graph::Outlook::kOver, Route()};
}

bool FootstepExplorer::MayGoOn() {
  const bool is_cut_short = search_->states() >= search_->most_states;
  search_->most_states *= 2;
  if (!is_cut_short) return false;
  if (search_->most_states <= kMostStates << steps_.doublings()) return true;
  steps_.OnCutShort();
  return false;
}

bool FootstepExplorer::OnRefuted() {
  if (proposals_ > 1) *gave_up_ = true;
  return proposals_ == 1;
}

/// The start, the stances on the way that meet C_S, and the goal.
std::vector<FootstepExplorer::Halt> FootstepExplorer::Halts() const {
  std::vector<Halt> halts = {{start_, -1, 0}};
  double time = 0;
  const std::vector<Footstep>& steps = search_->steps();
  const int last = static_cast<int>(steps.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    const Footstep& step = steps[i];
    time += ExpectedDuration(step);
    GroundedStance stance;
    stance.gait = start_.gait;
    stance.pose = step.to.stance;
    stance.z = step.to.z;
    if (gait().Examine(stance) == StanceFault::kNone) halts.push_back({stance, i, time});
  }
  halts.push_back({goals_[search_->goal()], last, time});
  return halts;
}

/// The quickest sequence of straight ways that meet C_S and of planned steps between halts.
std::vector<graph::PathEdge> FootstepExplorer::Route() const {
  const std::vector<Halt> halts = Halts();
  std::vector<double> time(halts.size(), std::numeric_limits<double>::infinity());
  std::vector<int> before(halts.size(), -1);
  std::vector<bool> is_walked(halts.size(), false);
  time[0] = 0;
  for (std::size_t i = 0; i < halts.size(); ++i) {
    for (std::size_t j = i + 1; j < halts.size(); ++j) {
      const GroundedStance& from = halts[i].stance;
      const GroundedStance& to = halts[j].stance;
      const double steps = time[i] + kStop + halts[j].time - halts[i].time;
      const double walk = from.z == to.z ? time[i] + gait().DurationAlone(from.pose, to.pose)
                                         : std::numeric_limits<double>::infinity();
      const bool walks = walk < steps && walk < time[j] && gait().CS(from, to);
      const double best = walks ? walk : steps;
      if (best >= time[j]) continue;
      time[j] = best;
      before[j] = static_cast<int>(i);
      is_walked[j] = walks;
    }
  }
  std::vector<graph::PathEdge> edges;
  for (int j = static_cast<int>(halts.size()) - 1; j > 0; j = before[j]) {
    const Halt& from = halts[before[j]];
    const graph::PathEdge edge =
        EdgeBetween(is_walked[j] ? start_.gait : action_, from.stance, halts[j].stance);
    if (!is_walked[j]) {
      std::vector<Footstep> steps = StepsBetween(from, halts[j]);
      if (!steps.empty()) steps_.Suggest(edge.points, std::move(steps));
    }
    edges.insert(edges.begin(), edge);
  }
  return edges;
}

std::vector<Footstep> FootstepExplorer::StepsBetween(const Halt& from, const Halt& to) const {
  std::vector<Footstep> steps;
  const auto limbs = static_cast<int>(space_.model->gaits[start_.gait]->stance.gait->limbs.size());
  std::vector<Foothold> feet(limbs, Foothold{from.stance.pose, from.stance.z});
  const auto step_to = [&](int limb, const Foothold& place) {
    const auto step = search_->StepBetween(feet, limb, place);
    if (step) steps.push_back(*step);
    feet[limb] = place;
    return step.has_value();
  };
  const std::vector<Footstep>& all = search_->steps();
  for (int i = from.step + 1; i <= to.step; ++i) {
    if (!step_to(all[i].limb, all[i].to)) return {};
  }
  // In turn, the last one last.
  for (int i = 1; i <= limbs; ++i) {
    const int behind = (all[to.step].limb + i) % limbs;
    const PlanarPose left = feet[behind].stance.Inverse() * to.stance.pose;
    const bool has_arrived = left.position().norm() < kArrived && std::abs(left.yaw) < kArrived;
    if (!has_arrived && !step_to(behind, {to.stance.pose, to.stance.z})) return {};
  }
  return steps;
}

std::vector<graph::PathEdge> FootstepExplorer::WholeWay() const {
  const graph::PathEdge edge = EdgeBetween(action_, start_, goals_[search_->goal()]);
  steps_.Suggest(edge.points, search_->steps());
  return {edge};
}

graph::PathEdge FootstepExplorer::EdgeBetween(int action, const GroundedStance& from,
                                              const GroundedStance& to) const {
  const NominalStance& stance = space_.model->gaits[start_.gait]->stance;
  return {action,
          {ToPoint(stance.RootPose(from.pose, from.z)), ToPoint(stance.RootPose(to.pose, to.z))}};
}

graph::ExplorerFactory FootstepExploration(const RouteSpace& space, const PlannedSteps& steps,
                                           int action, const GroundedStance& start,
                                           const std::vector<GroundedStance>& goals,
                                           const bool* is_called, bool* gave_up) {
  return [=, &steps](const graph::ExplorerContext& context) {
    return std::make_unique<FootstepExplorer>(space, steps, action, start, goals, is_called,
                                              gave_up, context);
  };
}

}  // namespace possibility::actions
