#include "actions/route_refinement.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>

namespace possibility::actions {
namespace {

using Actions = std::vector<std::shared_ptr<QuasiStaticAction>>;

/// More positions than this are thinned out: the cost of refining grows with their cube.
constexpr size_t kMaximumNodes = 30;

/// Places within legs of the found route are as far apart as this, m.
constexpr double kNodeSpacing = 0.4;

/// Passes over a route: each refines what the last one found, until that gains little.
constexpr int kMaximumPasses = 3;
constexpr double kWorthwhileGain = 0.02;

constexpr int kUnreached = -2;

enum class Validity { kUnknown, kClear, kBlocked };

/// A place on the found route where the robot could stand in the base gait.
struct Node {
  PlanarPose stance;
  /// Legs of the found route before this place, if the route stands there in the base gait.
  std::optional<size_t> found;
};

/// A way from one node to a later one, from and to the base gait.
struct Hop {
  int from = 0;
  int to = 0;
  double start_yaw = 0;
  double end_yaw = 0;
  double duration = 0;
  Validity validity = Validity::kUnknown;
  std::vector<RouteLeg> legs;  ///< none: the finish, a turn to the last heading
};

/// Refines a route that starts and ends in one gait, the base gait: A* over hops, where a hop and
/// the turn before it are tested only once they come first in the queue.
class RouteRefiner {
 public:
  RouteRefiner(const LocomotionModel& model, const Actions& actions, const Route& route,
               const std::function<bool()>& keep_going)
      : keep_going_(keep_going),
        model_(model),
        actions_(actions),
        route_(route),
        base_(StartGait(model, route.front())),
        parameters_(model.gaits[base_]->stance.gait->parameters) {
    AddNodes();
    AddFoundHops();
    AddStraightHops();
    AddFinish();
  }

  Route Refine() {
    struct Entry {
      double bound;     ///< on the whole duration
      double duration;  ///< up to the end of `hop`
      int hop;
      int before;  ///< -1: the start
      bool operator<(const Entry& other) const { return bound > other.bound; }
    };
    std::vector<std::vector<int>> leaving(nodes_.size());
    for (size_t i = 0; i < hops_.size(); ++i) leaving[hops_[i].from].push_back(static_cast<int>(i));
    std::vector<int> previous(hops_.size(), kUnreached);
    std::priority_queue<Entry> queue;
    const auto expand = [&](int before, int node, double duration, double yaw) {
      for (int next : leaving[node]) {
        const Hop& hop = hops_[next];
        if (previous[next] != kUnreached || hop.validity == Validity::kBlocked) continue;
        const double reached = duration + TurnDuration(yaw, hop.start_yaw) + hop.duration;
        queue.push({reached + LowerBound(hop.to), reached, next, before});
      }
    };
    expand(-1, 0, 0, route_.front().from.yaw);
    while (!queue.empty() && (!keep_going_ || keep_going_())) {
      const Entry entry = queue.top();
      queue.pop();
      if (previous[entry.hop] != kUnreached || !IsClear(entry.before, entry.hop)) continue;
      previous[entry.hop] = entry.before;
      const Hop& hop = hops_[entry.hop];
      if (hop.legs.empty()) return ToRoute(entry.before, previous);
      expand(entry.hop, hop.to, entry.duration, hop.end_yaw);
    }
    return route_;
  }

 private:
  void AddNodes() {
    std::vector<Node> all = {{route_.front().from, 0}};
    for (size_t i = 0; i < route_.size(); ++i) {
      AddNodesWithin(route_[i], &all);
      if (std::optional<PlanarPose> stance = InBaseGait(EndGait(model_, route_[i]), route_[i].to)) {
        all.push_back({*stance, std::nullopt});
        if (EndGait(model_, route_[i]) == base_) all.back().found = i + 1;
      }
    }
    const size_t chosen = std::min(all.size(), kMaximumNodes);
    for (size_t i = 0; i < chosen; ++i) nodes_.push_back(all[i * (all.size() - 1) / (chosen - 1)]);
  }

  /// Places between the ends of a long leg, where a change of gait may pay.
  void AddNodesWithin(const RouteLeg& leg, std::vector<Node>* all) const {
    if (leg.transition >= 0) return;
    const double length = (leg.to.position() - leg.from.position()).norm();
    const int parts = static_cast<int>(length / kNodeSpacing);
    for (int part = 1; part < parts; ++part) {
      const PlanarPose stance = Interpolate(leg.from, leg.to, static_cast<double>(part) / parts);
      if (std::optional<PlanarPose> in_base = InBaseGait(leg.gait, stance)) {
        all->push_back({*in_base, std::nullopt});
      }
    }
  }

  /// The stance in the base gait from which (or to which) a transition leads to `stance`.
  std::optional<PlanarPose> InBaseGait(int gait, const PlanarPose& stance) const {
    if (gait == base_) return stance;
    const std::optional<PlanarPose> displacement = Displacement(gait);
    if (!displacement) return std::nullopt;
    return stance * displacement->Inverse();
  }

  /// Of the stance of `gait`, after a transition from the base gait, in the base gait's stance.
  std::optional<PlanarPose> Displacement(int gait) const {
    for (const LocomotionModel::TransitionEntry& transition : model_.transitions) {
      const PlanarPose& displacement = transition.motion->displacement();
      if (transition.from == base_ && transition.to == gait) return displacement;
      if (transition.to == base_ && transition.from == gait) return displacement.Inverse();
    }
    return std::nullopt;
  }

  /// The found route between neighbouring nodes, known to be clear.
  void AddFoundHops() {
    int last = 0;
    for (int i = 1; i < static_cast<int>(nodes_.size()); ++i) {
      if (!nodes_[i].found) continue;
      Hop hop;
      hop.from = last;
      hop.to = i;
      hop.legs.assign(route_.begin() + static_cast<std::ptrdiff_t>(*nodes_[last].found),
                      route_.begin() + static_cast<std::ptrdiff_t>(*nodes_[i].found));
      hop.start_yaw = hop.legs.front().from.yaw;
      hop.end_yaw = hop.legs.back().to.yaw;
      hop.duration = ExpectedDuration(model_, hop.legs);
      hop.validity = Validity::kClear;
      hops_.push_back(std::move(hop));
      last = i;
    }
  }

  void AddStraightHops() {
    for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
      for (int j = i + 1; j < static_cast<int>(nodes_.size()); ++j) {
        const PlanarPose& a = nodes_[i].stance;
        const PlanarPose& b = nodes_[j].stance;
        if ((b.position() - a.position()).norm() < 1e-6) continue;
        const double heading = std::atan2(b.y - a.y, b.x - a.x);
        for (const double yaw : {heading, heading + std::numbers::pi}) {
          for (int gait = 0; gait < static_cast<int>(model_.gaits.size()); ++gait) {
            AddStraightHop(i, j, yaw, gait);
          }
        }
      }
    }
  }

  void AddStraightHop(int i, int j, double yaw, int gait) {
    const PlanarPose a{nodes_[i].stance.x, nodes_[i].stance.y, yaw};
    const PlanarPose b{nodes_[j].stance.x, nodes_[j].stance.y, yaw};
    Hop hop;
    hop.from = i;
    hop.to = j;
    hop.start_yaw = hop.end_yaw = yaw;
    if (gait == base_) {
      hop.legs = {Extension(gait, a, b)};
    } else {
      const std::optional<PlanarPose> displacement = Displacement(gait);
      if (!displacement) return;
      const PlanarPose c = a * *displacement;
      const PlanarPose d = b * *displacement;
      hop.legs = {Transition(base_, gait, a, c), Extension(gait, c, d),
                  Transition(gait, base_, d, b)};
    }
    hop.duration = ExpectedDuration(model_, hop.legs);
    hops_.push_back(std::move(hop));
  }

  RouteLeg Extension(int gait, const PlanarPose& from, const PlanarPose& to) const {
    RouteLeg leg;
    leg.gait = gait;
    leg.from = from;
    leg.to = to;
    leg.z = leg.z_to = route_.front().z;
    return leg;
  }

  RouteLeg Transition(int from_gait, int to_gait, const PlanarPose& from,
                      const PlanarPose& to) const {
    RouteLeg leg = Extension(from_gait, from, to);
    for (size_t i = 0; i < model_.transitions.size(); ++i) {
      const LocomotionModel::TransitionEntry& transition = model_.transitions[i];
      const bool forwards = transition.from == from_gait && transition.to == to_gait;
      if (!forwards && !(transition.to == from_gait && transition.from == to_gait)) continue;
      leg.transition = static_cast<int>(i);
      leg.backwards = !forwards;
      break;
    }
    return leg;
  }

  /// A hop of no length from the last node, which turns to the last heading.
  void AddFinish() {
    Hop finish;
    finish.from = finish.to = static_cast<int>(nodes_.size()) - 1;
    finish.start_yaw = finish.end_yaw = route_.back().to.yaw;
    finish.validity = Validity::kClear;
    hops_.push_back(finish);
  }

  double TurnDuration(double from, double to) const {
    const double angle = std::abs(WrapAngle(to - from));
    if (angle < 1e-9) return 0;
    const double strides = std::ceil(angle / parameters_.turn - 1e-9);
    return model_.gaits[base_]->motion->ExpectedDuration(static_cast<int>(strides));
  }

  /// No way from the node to the end of the route is quicker, as long as no gait outpaces the
  /// base gait (a heuristic that overestimates costs optimality, never validity), s.
  double LowerBound(int node) const {
    const double length = (route_.back().to.position() - nodes_[node].stance.position()).norm();
    const double strides = std::ceil(length / parameters_.forward - 1e-9);
    return strides > 0 ? model_.gaits[base_]->motion->ExpectedDuration(static_cast<int>(strides))
                       : 0;
  }

  bool IsClear(const RouteLeg& leg) const {
    const QuasiStaticAction& action = *actions_[EndGait(model_, leg)];
    const graph::PointPair edge = LegEdge(model_, leg);
    if (leg.transition >= 0) return action.CS(edge);
    const GroundedStance from{leg.gait, leg.from, leg.z};
    const GroundedStance to{leg.gait, leg.to, leg.z};
    return !action.IsForbidden(edge) && action.Examine(from) == StanceFault::kNone &&
           action.Examine(to) == StanceFault::kNone && action.IsClear(from, to);
  }

  bool IsClear(int before, int index) {
    Hop& hop = hops_[index];
    if (hop.validity == Validity::kUnknown) {
      const bool clear = std::all_of(hop.legs.begin(), hop.legs.end(),
                                     [this](const RouteLeg& leg) { return IsClear(leg); });
      hop.validity = clear ? Validity::kClear : Validity::kBlocked;
    }
    if (hop.validity == Validity::kBlocked) return false;
    const double yaw = before < 0 ? route_.front().from.yaw : hops_[before].end_yaw;
    const double turn = WrapAngle(hop.start_yaw - yaw);
    if (std::abs(turn) < 1e-9) return true;
    const PlanarPose& at = nodes_[hop.from].stance;
    return IsClear(Extension(base_, {at.x, at.y, yaw}, {at.x, at.y, yaw + turn}));
  }

  void AppendTurn(double to_yaw, Route* route) const {
    const PlanarPose from = route->empty() ? route_.front().from : route->back().to;
    PlanarPose to = from;
    to.yaw += WrapAngle(to_yaw - from.yaw);
    if (std::abs(to.yaw - from.yaw) > 1e-9) route->push_back(Extension(base_, from, to));
  }

  Route ToRoute(int last, const std::vector<int>& previous) const {
    std::vector<int> sequence;
    for (int hop = last; hop >= 0; hop = previous[hop]) sequence.push_back(hop);
    Route route;
    for (auto index = sequence.rbegin(); index != sequence.rend(); ++index) {
      AppendTurn(hops_[*index].start_yaw, &route);
      route.insert(route.end(), hops_[*index].legs.begin(), hops_[*index].legs.end());
    }
    AppendTurn(route_.back().to.yaw, &route);
    return route;
  }

  const std::function<bool()>& keep_going_;
  const LocomotionModel& model_;
  const Actions& actions_;
  const Route& route_;
  int base_;
  const models::GaitParameters& parameters_;
  std::vector<Node> nodes_;
  std::vector<Hop> hops_;
};

/// Headings made continuous from leg to leg.
void Unwrap(Route* route) {
  for (size_t i = 1; i < route->size(); ++i) {
    RouteLeg& leg = (*route)[i];
    const double turn = WrapAngle(leg.to.yaw - leg.from.yaw);
    leg.from.yaw = (*route)[i - 1].to.yaw;
    leg.to.yaw = leg.from.yaw + turn;
  }
}

/// One pass over the pieces of a route that start and end in one gait. Manoeuvres stay as they are.
Route RefineOnce(const LocomotionModel& model, const Route& route, const Actions& actions,
                 const std::function<bool()>& keep_going) {
  Route refined;
  for (size_t begin = 0; begin < route.size();) {
    const int base = StartGait(model, route[begin]);
    // Up to where the route leaves its gait for good, or the ground.
    size_t end = begin;
    for (size_t i = begin; i < route.size() && route[i].manoeuvre == nullptr; ++i) {
      if (EndGait(model, route[i]) == base) end = i + 1;
    }
    if (end == begin) {
      refined.push_back(route[begin++]);
      continue;
    }
    const auto first = route.begin() + static_cast<std::ptrdiff_t>(begin);
    const Route piece(first, first + static_cast<std::ptrdiff_t>(end - begin));
    const Route quicker = RouteRefiner(model, actions, piece, keep_going).Refine();
    refined.insert(refined.end(), quicker.begin(), quicker.end());
    begin = end;
  }
  Unwrap(&refined);
  return refined;
}

}  // namespace

Route RefineRoute(const LocomotionModel& model, const Route& route, const Actions& actions,
                  const std::function<bool()>& keep_going) {
  Route best = route;
  double duration = ExpectedDuration(model, best);
  for (int pass = 0; pass < kMaximumPasses; ++pass) {
    Route refined = RefineOnce(model, best, actions, keep_going);
    const double refined_duration = ExpectedDuration(model, refined);
    if (refined_duration >= duration) break;
    const bool worthwhile = refined_duration < (1 - kWorthwhileGain) * duration;
    best = std::move(refined);
    duration = refined_duration;
    if (!worthwhile) break;
  }
  return best;
}

}  // namespace possibility::actions
