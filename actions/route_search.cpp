#include "actions/route_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <unordered_set>

#include "actions/exploration_pose.h"
#include "actions/gait_motion.h"

namespace possibility::actions {
namespace {

/// How far ahead a manoeuvre is asked to lead, m: first little, for the least demanding is the most
/// likely to be confirmed, then more, until it lands somewhere.
constexpr double kLeastAhead = 0.2;
constexpr double kMostAhead = 2;
constexpr double kAheadStep = 0.05;

/// Of strides ahead that are blocked.
constexpr int kMostHalvings = 3;

constexpr double kSamePoint = 1e-9;

class RouteSearch {
 public:
  RouteSearch(const RouteSearchSpace& space, const std::vector<GroundedStance>& goals,
              const RouteSearchSettings& settings, const std::function<bool()>& keep_going)
      : space_(space), goals_(goals), settings_(settings), keep_going_(keep_going) {
    for (const auto& gait : space.model->gaits) {
      const models::GaitParameters& parameters = gait->stance.gait->parameters;
      stride_times_.push_back(gait->motion->ExpectedDuration(1));
      least_seconds_per_metre_ =
          std::min(least_seconds_per_metre_,
                   stride_times_.back() / std::max(parameters.forward, parameters.lateral));
    }
  }

  std::vector<graph::PathEdge> Run(const GroundedStance& start) {
    Push({.stance = start});
    while (!open_.empty()) {
      if (examined_ > settings_.most_stances || (keep_going_ && !keep_going_())) return {};
      const Candidate next = open_.top();
      open_.pop();
      if (next.launches) {
        Manoeuvres(next.node);
      } else if (!nodes_[next.node].is_goal && closed_.contains(CellOf(nodes_[next.node]))) {
        continue;
      } else if (!IsReached(next.node)) {
        Halve(next.node);
      } else if (nodes_[next.node].is_goal) {
        return EdgesTo(next.node);
      } else {
        closed_.insert(CellOf(nodes_[next.node]));
        Expand(next.node);
      }
    }
    return {};
  }

 private:
  struct Node {
    GroundedStance stance;
    int parent = -1;
    int action = 0;    ///< that leads here from the parent
    double cost = 0;   ///< s
    int halvings = 0;  ///< of the stride that leads here
    bool is_goal = false;
    bool is_ahead = false;  ///< reached by a stride forward
  };
  struct Candidate {
    double priority = 0;
    int node = 0;
    bool launches = false;  ///< whether it is the manoeuvres' turn there
    bool operator<(const Candidate& other) const {
      return priority != other.priority ? priority > other.priority : node > other.node;
    }
  };

  graph::Point PointOf(const GroundedStance& stance) const {
    return ToPoint(space_.model->gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
  }
  int num_gaits() const { return static_cast<int>(space_.gaits->size()); }
  const Manoeuvre& ManoeuvreOf(int action) const {
    return *(*space_.manoeuvres)[action - num_gaits()];
  }
  double turn() const { return 2 * std::numbers::pi / settings_.headings; }

  /// Of the lattice, at whatever distance from the origin.
  struct Cell {
    std::int64_t x;
    std::int64_t y;
    std::int64_t z;
    std::int64_t heading;
    int halvings;
    int gait;
    bool operator==(const Cell&) const = default;
  };
  struct HashOfCell {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t part :
           {cell.x, cell.y, cell.z, cell.heading * 64 + cell.halvings * 8 + cell.gait}) {
        hash = (hash ^ static_cast<std::uint64_t>(part)) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };

  Cell CellOf(const Node& node) const {
    const GroundedStance& stance = node.stance;
    const auto heading = static_cast<std::int64_t>(std::llround(stance.pose.yaw / turn()));
    const std::int64_t wrapped =
        ((heading % settings_.headings) + settings_.headings) % settings_.headings;
    const double size = settings_.step / (1 << node.halvings);
    return {std::llround(stance.pose.x / size),
            std::llround(stance.pose.y / size),
            std::llround(stance.z * 100),
            wrapped,
            node.halvings,
            stance.gait};
  }

  double LeftFrom(const PlanarPose& pose) const {
    double least = std::numeric_limits<double>::infinity();
    for (const GroundedStance& goal : goals_) {
      least = std::min(least, (goal.pose.position() - pose.position()).norm());
    }
    return settings_.greed * least * least_seconds_per_metre_;
  }

  void Push(const Node& node) {
    nodes_.push_back(node);
    const double later = node.halvings > 0 ? Patience(node.stance.gait) : 0;
    open_.push(
        {node.cost + later + LeftFrom(node.stance.pose), static_cast<int>(nodes_.size()) - 1});
  }

  /// Whether a node is new, and the way to it from its parent is one; asked when its turn has come.
  bool IsReached(int index) {
    const Node node = nodes_[index];
    if (node.parent < 0) return true;
    ++examined_;
    const GroundedStance& from = nodes_[node.parent].stance;
    if (node.action >= num_gaits()) {
      return ManoeuvreOf(node.action)
          .Explorable(graph::PointPair{PointOf(from), PointOf(node.stance)});
    }
    const QuasiStaticAction& gait = *(*space_.gaits)[node.action];
    if (from.gait == node.stance.gait) return gait.CS(from, node.stance);
    return gait.Examine(node.stance) == StanceFault::kNone &&
           gait.CS(graph::PointPair{PointOf(from), PointOf(node.stance)});
  }

  void Expand(int node) {
    Stride(node);
    Change(node);
    Finish(node);
    if (!MayLaunch(nodes_[node].stance.gait)) return;
    const GroundedStance& stance = nodes_[node].stance;
    const double later = Patience(stance.gait);
    open_.push({nodes_[node].cost + later + LeftFrom(stance.pose), node, true});
  }

  bool MayLaunch(int gait) const {
    return std::any_of(space_.manoeuvres->begin(), space_.manoeuvres->end(),
                       [gait](const auto& manoeuvre) { return manoeuvre->from() == gait; });
  }

  /// Where the lattice ends before an edge or a wall, shorter strides lead up to it: manoeuvres
  /// begin there.
  void Halve(int blocked) {
    const Node node = nodes_[blocked];
    if (!node.is_ahead || node.halvings == kMostHalvings || !MayLaunch(node.stance.gait)) return;
    StrideAhead(node.parent, node.halvings + 1);
  }

  void StrideAhead(int node, int halvings) {
    const GroundedStance& from = nodes_[node].stance;
    const PlanarPose displacement{settings_.step / (1 << halvings), 0, 0};
    Node next{.stance = from,
              .parent = node,
              .action = from.gait,
              .cost = nodes_[node].cost + StrideTime(from.gait, displacement),
              .halvings = halvings,
              .is_ahead = true};
    next.stance.pose = from.pose * displacement;
    Offer(next);
  }

  /// To a stance of the same gait, of another, or beyond a manoeuvre.
  bool Offer(int node, const GroundedStance& next, int action, double duration) {
    return Offer(
        {.stance = next, .parent = node, .action = action, .cost = nodes_[node].cost + duration});
  }
  bool Offer(const Node& next) {
    if (closed_.contains(CellOf(next))) return false;
    Push(next);
    return true;
  }

  /// What leads on without a manoeuvre comes first, for it costs less to find out: manoeuvres, and
  /// the shorter strides to where they begin, wait as if they took so much longer.
  double Patience(int gait) const { return 2 * StrideTime(gait, {settings_.step, 0, 0}); }

  double StrideTime(int gait, const PlanarPose& displacement) const {
    return StrideEffort(space_.model->gaits[gait]->stance.gait->parameters, displacement) *
           stride_times_[gait];
  }

  void Stride(int node) {
    const GroundedStance from = nodes_[node].stance;
    const double step = settings_.step;
    StrideAhead(node, 0);
    for (const PlanarPose& displacement :
         {PlanarPose{-step, 0, 0}, PlanarPose{0, step, 0}, PlanarPose{0, -step, 0},
          PlanarPose{0, 0, turn()}, PlanarPose{0, 0, -turn()}}) {
      GroundedStance next = from;
      next.pose = from.pose * displacement;
      Offer(node, next, from.gait, StrideTime(from.gait, displacement));
    }
  }

  void Change(int node) {
    const GroundedStance from = nodes_[node].stance;
    for (const LocomotionModel::TransitionEntry& transition : space_.model->transitions) {
      const PlanarPose& d = transition.motion->displacement();
      GroundedStance next = from;
      if (transition.from == from.gait) {
        next.gait = transition.to;
        next.pose = from.pose * d;
      } else if (transition.to == from.gait) {
        next.gait = transition.from;
        next.pose = from.pose * d.Inverse();
      } else {
        continue;
      }
      Offer(node, next, next.gait, transition.motion->ExpectedDuration());
    }
  }

  /// Straight to a goal that is near.
  void Finish(int node) {
    const GroundedStance from = nodes_[node].stance;
    for (const GroundedStance& goal : goals_) {
      const PlanarPose left = from.pose.Inverse() * goal.pose;
      if (goal.gait != from.gait || std::abs(goal.z - from.z) > 1e-6) continue;
      if (left.position().norm() > 2 * settings_.step) continue;
      const PlanarPose way{left.x, left.y, WrapAngle(left.yaw)};
      const double duration = StrideTime(from.gait, way);
      Push({.stance = goal,
            .parent = node,
            .action = from.gait,
            .cost = nodes_[node].cost + duration,
            .is_goal = true});
    }
  }

  void Manoeuvres(int node) {
    for (std::size_t i = 0; i < space_.manoeuvres->size(); ++i) {
      const Manoeuvre& manoeuvre = *(*space_.manoeuvres)[i];
      if (manoeuvre.from() != nodes_[node].stance.gait) continue;
      const graph::Point v = PointOf(nodes_[node].stance);
      const std::optional<graph::Point> launch =
          manoeuvre.FindLaunchPoint(v, PointAhead(node, kMostAhead));
      if (!launch) continue;
      if ((*launch - v).norm() > kSamePoint) {
        WalkTo(*launch, node);
        continue;
      }
      const std::vector<graph::Point> landings = Landings(node, manoeuvre);
      for (auto end = landings.rbegin(); end != landings.rend(); ++end) {
        const auto stance = AsStance(*space_.model, manoeuvre.to(), ToPose(*end));
        ++examined_;
        if (!stance || (*space_.gaits)[manoeuvre.to()]->Examine(*stance) != StanceFault::kNone)
          continue;
        if (!Launches(manoeuvre, v, *end)) continue;
        const double duration = manoeuvre.ExpectedDuration({v, *end});
        if (Offer(node, *stance, static_cast<int>(num_gaits() + i), duration)) break;
      }
    }
  }

  /// Straight to where a manoeuvre begins.
  void WalkTo(const graph::Point& launch, int node) {
    const GroundedStance& from = nodes_[node].stance;
    const std::optional<GroundedStance> stance = AsStance(*space_.model, from.gait, ToPose(launch));
    if (!stance) return;
    PlanarPose way = from.pose.Inverse() * stance->pose;
    way.yaw = WrapAngle(way.yaw);
    Offer({.stance = *stance,
           .parent = node,
           .action = from.gait,
           .cost = nodes_[node].cost + StrideTime(from.gait, way),
           .halvings = kMostHalvings});
  }

  graph::Point PointAhead(int node, double distance) const {
    GroundedStance ahead = nodes_[node].stance;
    ahead.pose = ahead.pose * PlanarPose{distance, 0, 0};
    return PointOf(ahead);
  }

  bool Launches(const Manoeuvre& manoeuvre, const graph::Point& v, const graph::Point& end) const {
    const std::optional<graph::Point> launch = manoeuvre.FindLaunchPoint(v, end);
    return launch && (*launch - v).norm() < kSamePoint;
  }

  /// Where a manoeuvre straight ahead from a node might end, far ones first.
  std::vector<graph::Point> Landings(int node, const Manoeuvre& manoeuvre) const {
    std::vector<graph::Point> landings;
    const graph::Point v = PointOf(nodes_[node].stance);
    for (double distance = kMostAhead; distance > kLeastAhead - kSamePoint;) {
      graph::Point end = manoeuvre.ExtendTowards(v, PointAhead(node, distance));
      const double length = (end - v).head<2>().norm();
      if (length < kSamePoint) break;
      if (landings.empty() || (landings.back() - end).norm() > kSamePoint) landings.push_back(end);
      distance = std::min(distance, length) - kAheadStep;
    }
    return landings;
  }

  std::vector<graph::PathEdge> EdgesTo(int last) const {
    std::vector<int> way;
    for (int node = last; node >= 0; node = nodes_[node].parent) way.push_back(node);
    std::reverse(way.begin(), way.end());
    std::vector<graph::PathEdge> edges;
    for (std::size_t i = 1; i < way.size(); ++i) {
      const std::size_t end = EndOfStraight(way, i);
      graph::PathEdge edge = EdgeBetween(way[i - 1], way[end]);
      if (end > i && !(*space_.gaits)[edge.action]->CS(edge.points)) {
        edge = EdgeBetween(way[i - 1], way[i]);
      } else {
        i = end;
      }
      edges.push_back(std::move(edge));
    }
    return edges;
  }

  /// The last node of a way that is straight on from nodes `first` - 1 and `first`.
  std::size_t EndOfStraight(const std::vector<int>& way, std::size_t first) const {
    const auto stance = [&](std::size_t i) { return nodes_[way[i]].stance; };
    const auto is_stride = [&](std::size_t i) {
      return nodes_[way[i]].action == stance(i).gait && stance(i).gait == stance(i - 1).gait &&
             std::abs(stance(i).pose.yaw - stance(i - 1).pose.yaw) < kSamePoint;
    };
    const auto direction = [&](std::size_t i) {
      return (stance(i).pose.position() - stance(i - 1).pose.position()).normalized();
    };
    std::size_t last = first;
    while (last + 1 < way.size() && is_stride(last) && is_stride(last + 1) &&
           (direction(last + 1) - direction(first)).norm() < kSamePoint) {
      ++last;
    }
    return last;
  }

  graph::PathEdge EdgeBetween(int from, int to) const {
    return {nodes_[to].action, {PointOf(nodes_[from].stance), PointOf(nodes_[to].stance)}};
  }

  const RouteSearchSpace& space_;
  const std::vector<GroundedStance>& goals_;
  const RouteSearchSettings& settings_;
  const std::function<bool()>& keep_going_;
  std::vector<double> stride_times_;  ///< s, by gait
  double least_seconds_per_metre_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::priority_queue<Candidate> open_;
  std::unordered_set<Cell, HashOfCell> closed_;
  std::int64_t examined_ = 0;
};

}  // namespace

std::vector<graph::PathEdge> SearchRoute(const RouteSearchSpace& space, const GroundedStance& start,
                                         const std::vector<GroundedStance>& goals,
                                         const RouteSearchSettings& settings,
                                         const std::function<bool()>& keep_going) {
  return RouteSearch(space, goals, settings, keep_going).Run(start);
}

}  // namespace possibility::actions
