#include "actions/route/shortcuts.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "actions/route/route.h"
#include "actions/route/shortcut_roadmap.h"

namespace possibility::actions {
namespace {

/// Edges of a route that are searched together.
constexpr std::size_t kWindow = 20;

constexpr int kUnreached = -2;
constexpr int kStart = -1;

using Edges = std::vector<graph::PathEdge>;

/// A* over the hops of a roadmap. A hop and the turn before it are tested only when they come first
/// in the queue.
class ShortcutSearch {
 public:
  ShortcutSearch(const RouteSpace& space, const std::vector<RouteStop>& stops,
                 const std::vector<GroundedStance>& goals, const CancellationToken& cancellation)
      : space_(space),
        stops_(stops),
        cancellation_(cancellation),
        roadmap_(space, stops, goals),
        leaving_(roadmap_.places().size()),
        previous_(roadmap_.hops().size(), kUnreached) {
    for (std::size_t i = 0; i < roadmap_.hops().size(); ++i) {
      leaving_[roadmap_.hops()[i].from].push_back(static_cast<int>(i));
    }
    for (const auto& gait : space.model->gaits) {
      const models::GaitParameters& parameters = gait->stance.gait->parameters;
      pace_ = std::min(pace_, LeastSecondsPerMetre(*gait->motion, parameters));
    }
    // Manoeuvres may be quicker than any gait.
    if (roadmap_.has_manoeuvres()) pace_ = 0;
  }

  /// None if it was told to stop.
  std::optional<Edges> Run() {
    Expand(kStart);
    while (!open_.empty() && cancellation_.Proceed()) {
      const Candidate next = open_.top();
      open_.pop();
      if (next.finish >= 0) {
        if (IsClear(&finishing_[next.finish])) return EdgesTo(next);
        continue;
      }
      if (previous_[next.hop] != kUnreached || !IsClear(&roadmap_.hops()[next.hop])) continue;
      Hop turn = TurnInto(next.before, roadmap_.hops()[next.hop]);
      if (!IsClear(&turn)) continue;
      previous_[next.hop] = next.before;
      duration_[next.hop] = next.duration;
      Expand(next.hop);
    }
    return std::nullopt;
  }

 private:
  struct Candidate {
    double bound = 0;     ///< on the whole duration, s
    double duration = 0;  ///< to the end of `hop`, s
    int hop = kStart;
    int before = kStart;  ///< hop
    int finish = -1;      ///< index into finishing_: the last turn, after hop `before`
    bool operator<(const Candidate& other) const {
      return bound != other.bound ? bound > other.bound : hop > other.hop;
    }
  };

  int PlaceAfter(int hop) const { return hop == kStart ? 0 : roadmap_.hops()[hop].to; }
  double YawAfter(int hop) const {
    return hop == kStart ? stops_.front().stance.pose.yaw : roadmap_.hops()[hop].end_yaw;
  }
  Hop TurnInto(int before, const Hop& hop) const {
    return roadmap_.Turn(hop.from, YawAfter(before), hop.start_yaw);
  }

  void Expand(int hop) {
    const double duration = hop == kStart ? 0 : duration_[hop];
    const int place = PlaceAfter(hop);
    for (const int next : leaving_[place]) {
      const Hop& step = roadmap_.hops()[next];
      if (previous_[next] != kUnreached || step.validity == Validity::kBlocked) continue;
      const double turn = roadmap_.TurnDuration(place, YawAfter(hop), step.start_yaw);
      const double reached = duration + turn + step.duration;
      open_.push({reached + LowerBound(step.to), reached, next, hop, -1});
    }
    for (const Finish& finish : roadmap_.finishes()) {
      if (finish.place != place) continue;
      Hop turn = roadmap_.Turn(place, YawAfter(hop), finish.yaw);
      const double reached = duration + turn.duration;
      open_.push({reached, reached, kStart, hop, static_cast<int>(finishing_.size())});
      finishing_.push_back(std::move(turn));
    }
  }

  double LowerBound(int place) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Finish& finish : roadmap_.finishes()) {
      const double length = (roadmap_.places()[finish.place].p - roadmap_.places()[place].p).norm();
      least = std::min(least, length * pace_);
    }
    return least;
  }

  bool IsClear(Hop* hop) const {
    if (hop->validity == Validity::kUnknown) {
      const bool clear =
          std::all_of(hop->edges.begin(), hop->edges.end(), [this](const graph::PathEdge& edge) {
            return (*space_.gaits)[edge.action]->CS(edge.points);
          });
      hop->validity = clear ? Validity::kClear : Validity::kBlocked;
    }
    return hop->validity == Validity::kClear;
  }

  Edges EdgesTo(const Candidate& finish) const {
    std::vector<int> sequence;
    for (int hop = finish.before; hop != kStart; hop = previous_[hop]) sequence.push_back(hop);
    std::reverse(sequence.begin(), sequence.end());
    Edges edges;
    int before = kStart;
    for (const int index : sequence) {
      const Hop& hop = roadmap_.hops()[index];
      const Hop turn = TurnInto(before, hop);
      edges.insert(edges.end(), turn.edges.begin(), turn.edges.end());
      edges.insert(edges.end(), hop.edges.begin(), hop.edges.end());
      before = index;
    }
    const Hop& last = finishing_[finish.finish];
    edges.insert(edges.end(), last.edges.begin(), last.edges.end());
    return edges;
  }

  const RouteSpace& space_;
  const std::vector<RouteStop>& stops_;
  const CancellationToken& cancellation_;
  ShortcutRoadmap roadmap_;
  std::vector<std::vector<int>> leaving_;  ///< hops, by place
  std::vector<int> previous_;              ///< by hop
  std::vector<double> duration_ = std::vector<double>(previous_.size(), 0);
  std::vector<Hop> finishing_;
  std::priority_queue<Candidate> open_;
  double pace_ = std::numeric_limits<double>::infinity();  ///< least, s/m
};

std::vector<RouteStop> StopsOf(const RouteSpace& space, const Edges& route) {
  const std::vector<std::shared_ptr<SearchedManoeuvre>>& manoeuvres = *space.manoeuvres;
  const Route legs = RouteAlong(*space.model, manoeuvres, route);
  std::vector<RouteStop> stops = {
      {{StartGait(*space.model, legs.front()), legs.front().from, legs.front().z}, {}}};
  for (std::size_t i = 0; i < legs.size(); ++i) {
    stops.push_back({{EndGait(*space.model, legs[i]), legs[i].to, legs[i].z_to}, route[i]});
  }
  return stops;
}

}  // namespace

std::vector<graph::PathEdge> FindShortcuts(const RouteSpace& space,
                                           const std::vector<graph::PathEdge>& route,
                                           const std::vector<GroundedStance>& goals,
                                           const CancellationToken& cancellation) {
  static const std::vector<GroundedStance> kNoGoals;
  Edges result;
  Edges rest = route;
  while (!rest.empty()) {
    const bool is_last = rest.size() <= kWindow;
    const auto end = rest.begin() + static_cast<std::ptrdiff_t>(std::min(rest.size(), kWindow));
    const Edges window(rest.begin(), end);
    const std::vector<RouteStop> stops = StopsOf(space, window);
    const Edges quicker = ShortcutSearch(space, stops, is_last ? goals : kNoGoals, cancellation)
                              .Run()
                              .value_or(window);
    // The next window begins half-way through the result of this one.
    const std::size_t kept =
        is_last || quicker.size() >= 2 * kWindow ? quicker.size() : (quicker.size() + 1) / 2;
    const auto middle = quicker.begin() + static_cast<std::ptrdiff_t>(kept);
    result.insert(result.end(), quicker.begin(), middle);
    Edges next(middle, quicker.end());
    next.insert(next.end(), end, rest.end());
    rest = std::move(next);
  }
  return result;
}

}  // namespace possibility::actions
