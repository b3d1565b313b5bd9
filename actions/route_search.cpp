#include "actions/route_search.h"

#include <algorithm>
#include <array>
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
    Push({start, -1, 0, 0});
    if (const int last = StraightOn(start); last >= 0) return EdgesTo(last);
    while (!open_.empty()) {
      if (examined_ > settings_.most_stances || (keep_going_ && !keep_going_())) return {};
      const int node = open_.top().node;
      open_.pop();
      if (!IsReached(node)) continue;
      if (nodes_[node].is_goal) return EdgesTo(node);
      if (!closed_.insert(CellOf(nodes_[node].stance)).second) continue;
      Expand(node);
    }
    return {};
  }

 private:
  struct Node {
    GroundedStance stance;
    int parent = -1;
    int action = 0;   ///< that leads here from the parent
    double cost = 0;  ///< s
    bool is_goal = false;
  };
  struct Candidate {
    double priority = 0;
    int node = 0;
    bool operator<(const Candidate& other) const {
      return priority != other.priority ? priority > other.priority : node > other.node;
    }
  };

  const PlanarPose& PoseOf(int node) const { return nodes_[node].stance.pose; }

  graph::Point PointOf(const GroundedStance& stance) const {
    return ToPoint(space_.model->gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
  }

  std::int64_t CellOf(const GroundedStance& stance) const {
    const double turn = 2 * std::numbers::pi / settings_.headings;
    const auto heading = static_cast<std::int64_t>(std::llround(stance.pose.yaw / turn));
    const std::int64_t wrapped =
        ((heading % settings_.headings) + settings_.headings) % settings_.headings;
    const std::int64_t x = std::llround(stance.pose.x / settings_.step) + (1 << 15);
    const std::int64_t y = std::llround(stance.pose.y / settings_.step) + (1 << 15);
    const std::int64_t z = std::llround(stance.z * 100) + (1 << 12);
    return (((z << 16 | x) << 16 | y) << 8 | wrapped) << 4 | stance.gait;
  }

  double LeftFrom(const GroundedStance& stance) const {
    double least = std::numeric_limits<double>::infinity();
    for (const GroundedStance& goal : goals_) {
      least = std::min(least, (goal.pose.position() - stance.pose.position()).norm());
    }
    return least * least_seconds_per_metre_;
  }

  void Push(const Node& node) {
    nodes_.push_back(node);
    open_.push(
        {node.cost + settings_.greed * LeftFrom(node.stance), static_cast<int>(nodes_.size()) - 1});
  }

  /// Whether the way to a node from its parent is one; asked when its turn has come.
  bool IsReached(int node) {
    const Node& reached = nodes_[node];
    if (reached.parent < 0) return true;
    if (!reached.is_goal && closed_.contains(CellOf(reached.stance))) return false;
    const graph::PointPair edge = {PointOf(nodes_[reached.parent].stance), PointOf(reached.stance)};
    const int num_gaits = static_cast<int>(space_.gaits->size());
    if (reached.action < num_gaits) return (*space_.gaits)[reached.action]->CS(edge);
    return (*space_.manoeuvres)[reached.action - num_gaits]->Explorable(edge);
  }

  void Expand(int node) {
    Stride(node);
    Change(node);
    Finish(node);
    Manoeuvres(node);
  }

  /// To a stance of the same gait, of another, or beyond a manoeuvre.
  bool Offer(int node, const GroundedStance& next, int action, double duration) {
    if (closed_.contains(CellOf(next))) return false;
    ++examined_;
    if ((*space_.gaits)[next.gait]->Examine(next) != StanceFault::kNone) return false;
    Push({next, node, action, nodes_[node].cost + duration});
    return true;
  }

  void Stride(int node) {
    const GroundedStance from = nodes_[node].stance;
    const double turn = 2 * std::numbers::pi / settings_.headings;
    const double step = settings_.step;
    const models::GaitParameters& parameters =
        space_.model->gaits[from.gait]->stance.gait->parameters;
    for (const PlanarPose& displacement :
         {PlanarPose{step, 0, 0}, PlanarPose{-step, 0, 0}, PlanarPose{0, step, 0},
          PlanarPose{0, -step, 0}, PlanarPose{0, 0, turn}, PlanarPose{0, 0, -turn}}) {
      GroundedStance next = from;
      next.pose = from.pose * displacement;
      Offer(node, next, from.gait,
            StrideEffort(parameters, displacement) * stride_times_[from.gait]);
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

  /// The node of a goal that the straight way from the start leads to; -1 if there is none.
  int StraightOn(const GroundedStance& start) {
    for (const GroundedStance& goal : goals_) {
      if (goal.gait != start.gait) continue;
      nodes_.push_back({goal, 0, start.gait, 0, true});
      const int last = static_cast<int>(nodes_.size()) - 1;
      if (IsReached(last)) return last;
    }
    return -1;
  }

  /// Straight to a goal that is near.
  void Finish(int node) {
    const GroundedStance from = nodes_[node].stance;
    for (const GroundedStance& goal : goals_) {
      const PlanarPose left = from.pose.Inverse() * goal.pose;
      if (goal.gait != from.gait || std::abs(goal.z - from.z) > 1e-6) continue;
      if (left.position().norm() > 2 * settings_.step) continue;
      const PlanarPose way{left.x, left.y, WrapAngle(left.yaw)};
      const models::GaitParameters& parameters =
          space_.model->gaits[from.gait]->stance.gait->parameters;
      Node last{goal, node, from.gait, nodes_[node].cost, true};
      last.cost += StrideEffort(parameters, way) * stride_times_[from.gait];
      Push(last);
    }
  }

  void Manoeuvres(int node) {
    for (std::size_t i = 0; i < space_.manoeuvres->size(); ++i) {
      const Manoeuvre& manoeuvre = *(*space_.manoeuvres)[i];
      if (manoeuvre.from() != nodes_[node].stance.gait) continue;
      if (!Landing(node, manoeuvre, kMostAhead)) continue;
      for (double ahead = kLeastAhead; ahead < kMostAhead; ahead += kAheadStep) {
        if (Execute(node, manoeuvre, static_cast<int>(space_.gaits->size() + i), ahead)) break;
      }
    }
  }

  bool Execute(int node, const Manoeuvre& manoeuvre, int action, double distance) {
    const std::optional<GroundedStance> landing = Landing(node, manoeuvre, distance);
    if (!landing) return false;
    const graph::PointPair edge = {PointOf(nodes_[node].stance), PointOf(*landing)};
    return Offer(node, *landing, action, manoeuvre.ExpectedDuration(edge));
  }

  /// Where a manoeuvre straight ahead from a node, so far at most, would end.
  std::optional<GroundedStance> Landing(int node, const Manoeuvre& manoeuvre,
                                        double distance) const {
    GroundedStance ahead = nodes_[node].stance;
    ahead.pose = ahead.pose * PlanarPose{distance, 0, 0};
    const graph::Point v = PointOf(nodes_[node].stance);
    const graph::Point target = PointOf(ahead);
    const std::optional<graph::Point> launch = manoeuvre.FindLaunchPoint(v, target);
    if (!launch || (*launch - v).norm() > kSamePoint) return std::nullopt;
    const graph::Point end = manoeuvre.ExtendTowards(v, target);
    if ((end - v).norm() < kSamePoint) return std::nullopt;
    return AsStance(*space_.model, manoeuvre.to(), ToPose(end));
  }

  std::vector<graph::PathEdge> EdgesTo(int node) const {
    std::vector<graph::PathEdge> edges;
    for (; nodes_[node].parent >= 0; node = nodes_[node].parent) {
      edges.push_back(
          {nodes_[node].action,
           {PointOf(nodes_[nodes_[node].parent].stance), PointOf(nodes_[node].stance)}});
    }
    std::reverse(edges.begin(), edges.end());
    return edges;
  }

  const RouteSearchSpace& space_;
  const std::vector<GroundedStance>& goals_;
  const RouteSearchSettings& settings_;
  const std::function<bool()>& keep_going_;
  std::vector<double> stride_times_;  ///< s, by gait
  double least_seconds_per_metre_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::priority_queue<Candidate> open_;
  std::unordered_set<std::int64_t> closed_;
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
