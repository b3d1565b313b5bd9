#include "actions/route/lattice_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>

#include "actions/conditions/exploration_pose.h"
#include "actions/gait/gait_motion.h"
#include "graph/structure/vertex_index.h"

namespace possibility::actions {
namespace {

/// First distance ahead at which a landing of a manoeuvre is tried, m. It grows until a landing is
/// found: the least demanding manoeuvre is the most likely to be confirmed.
constexpr double kLeastAhead = 0.2;
constexpr double kMostAhead = 2;
constexpr double kAheadStep = 0.05;

/// Largest number of halvings of a blocked stride ahead.
constexpr int kMostHalvings = 3;

}  // namespace

LatticeSearch::LatticeSearch(const RouteSpace& space, const GroundedStance& start,
                             const std::vector<GroundedStance>& goals,
                             const LatticeSettings& settings)
    : space_(space), goals_(goals), settings_(settings) {
  for (const auto& gait : space.model->gaits) {
    const models::GaitParameters& parameters = gait->stance.gait->parameters;
    const GaitMotion& motion = *gait->motion;
    // What one stride takes beyond an additional one.
    stop_times_.push_back(2 * motion.ExpectedDuration(1) - motion.ExpectedDuration(2));
    least_seconds_per_metre_ =
        std::min(least_seconds_per_metre_, LeastSecondsPerMetre(motion, parameters));
  }
  Push({.stance = start});
}

LatticeSearch::Status LatticeSearch::Advance(std::int64_t stances,
                                             const CancellationToken& cancellation) {
  const std::int64_t end = examined_ + stances;
  while (!open_.empty() && examined_ <= settings_.most_stances) {
    if (examined_ >= end || !cancellation.Proceed()) return Status::kSearching;
    const Candidate next = open_.top();
    open_.pop();
    if (next.launches) {
      Manoeuvres(next.node);
    } else if (!nodes_[next.node].is_goal && closed_.contains(CellOf(nodes_[next.node]))) {
      continue;
    } else if (!IsReached(next.node)) {
      Halve(next.node);
    } else if (nodes_[next.node].is_goal) {
      found_ = next.node;
      return Status::kFound;
    } else {
      const Node& node = nodes_[next.node];
      closest_approach_ = std::min(closest_approach_, DistanceLeft(node.stance.pose));
      closed_.insert(CellOf(node));
      reached_.push_back(next.node);
      Expand(next.node);
    }
  }
  return Status::kGivenUp;
}

graph::Point LatticeSearch::PointOf(const GroundedStance& stance) const {
  return ToPoint(space_.model->gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
}

double LatticeSearch::turn() const { return 2 * std::numbers::pi / settings_.headings; }

std::int64_t LatticeSearch::CellOf(const Node& node) const {
  const GroundedStance& stance = node.stance;
  const auto heading = static_cast<std::int64_t>(std::llround(stance.pose.yaw / turn()));
  const std::int64_t wrapped =
      ((heading % settings_.headings) + settings_.headings) % settings_.headings;
  const double size = settings_.step / (1 << node.halvings);
  const PlanarPose& origin = nodes_.front().stance.pose;
  const std::int64_t x = std::llround((stance.pose.x - origin.x) / size) + (1 << 15);
  const std::int64_t y = std::llround((stance.pose.y - origin.y) / size) + (1 << 15);
  const std::int64_t z = std::llround(stance.z * 100) + (1 << 12);
  return ((((z << 16 | x) << 16 | y) << 8 | wrapped) << 2 | node.halvings) << 3 | stance.gait;
}

double LatticeSearch::DistanceLeft(const PlanarPose& pose) const {
  double least = std::numeric_limits<double>::infinity();
  for (const GroundedStance& goal : goals_) {
    least = std::min(least, (goal.pose.position() - pose.position()).norm());
  }
  return least;
}

double LatticeSearch::TimeLeft(const PlanarPose& pose) const {
  return DistanceLeft(pose) * least_seconds_per_metre_;
}

double LatticeSearch::LowerBound() const {
  if (!space_.manoeuvres->empty()) return 0;
  if (found_ >= 0) return nodes_[found_].cost;
  if (open_.empty()) return bound_;
  const Node& first = nodes_[open_.top().node];
  return std::min(bound_, first.cost + TimeLeft(first.stance.pose));
}

void LatticeSearch::Push(const Node& node) {
  const double left = TimeLeft(node.stance.pose);
  if (node.cost + left >= bound_) return;
  nodes_.push_back(node);
  const double later = node.halvings > 0 ? Patience(node.stance.gait) : 0;
  open_.push(
      {node.cost + later + settings_.greed * left, static_cast<int>(nodes_.size()) - 1, false});
}

/// Whether a node is new and the way to it from its parent is valid; tested when the node is next
/// in the queue.
bool LatticeSearch::IsReached(int index) {
  const Node node = nodes_[index];
  if (node.parent < 0) return true;
  ++examined_;
  const GroundedStance& from = nodes_[node.parent].stance;
  if (node.action >= num_gaits()) {
    return ManoeuvreOf(node.action).Explorable(graph::Edge{PointOf(from), PointOf(node.stance)});
  }
  const QuasiStaticAction& gait = *(*space_.gaits)[node.action];
  if (from.gait == node.stance.gait) return gait.CS(from, node.stance);
  return gait.Examine(node.stance) == StanceFault::kNone &&
         gait.CS(graph::Edge{PointOf(from), PointOf(node.stance)});
}

void LatticeSearch::Expand(int node) {
  Stride(node);
  Change(node);
  Finish(node);
  if (!MayLaunch(nodes_[node].stance.gait)) return;
  const GroundedStance& stance = nodes_[node].stance;
  const double later = Patience(stance.gait);
  open_.push({nodes_[node].cost + later + settings_.greed * TimeLeft(stance.pose), node, true});
}

bool LatticeSearch::MayLaunch(int gait) const {
  return std::any_of(space_.manoeuvres->begin(), space_.manoeuvres->end(),
                     [gait](const auto& manoeuvre) { return manoeuvre->from() == gait; });
}

/// Adds shorter strides up to an edge of the ground or a wall, because manoeuvres begin there.
void LatticeSearch::Halve(int blocked) {
  const Node node = nodes_[blocked];
  if (node.direction != kAhead || node.halvings == kMostHalvings) return;
  if (!MayLaunch(node.stance.gait)) return;
  const int halvings = node.halvings + 1;
  StrideTo(node.parent, kAhead, {settings_.step / (1 << halvings), 0, 0}, halvings);
}

void LatticeSearch::StrideTo(int node, int direction, const PlanarPose& displacement,
                             int halvings) {
  const GroundedStance& from = nodes_[node].stance;
  Node next{
      .stance = from,
      .parent = node,
      .action = from.gait,
      .cost = nodes_[node].cost + StopTime(node, direction) + StrideTime(from.gait, displacement),
      .halvings = halvings,
      .direction = direction};
  next.stance.pose = from.pose * displacement;
  Offer(next);
}

/// Offers a stance of the same gait, of another gait, or after a manoeuvre.
bool LatticeSearch::Offer(int node, const GroundedStance& next, int action, double duration) {
  return Offer(
      {.stance = next, .parent = node, .action = action, .cost = nodes_[node].cost + duration});
}
bool LatticeSearch::Offer(const Node& next) {
  if (closed_.contains(CellOf(next))) return false;
  Push(next);
  return true;
}

/// Extra cost that delays manoeuvres and the shorter strides up to them in the queue: steps without
/// a manoeuvre come first because they are cheaper to test.
double LatticeSearch::Patience(int gait) const {
  return 2 * StrideTime(gait, {settings_.step, 0, 0});
}

double LatticeSearch::StrideTime(int gait, const PlanarPose& displacement) const {
  const LocomotionModel::GaitEntry& entry = *space_.model->gaits[gait];
  return entry.motion->DisplacementDuration(entry.stance.gait->parameters, displacement);
}

/// Time to stop, which ends every straight way.
double LatticeSearch::StopTime(int node, int direction) const {
  return nodes_[node].direction == direction ? 0 : stop_times_[nodes_[node].stance.gait];
}

void LatticeSearch::Stride(int node) {
  const double step = settings_.step;
  const PlanarPose displacements[] = {{step, 0, 0},  {-step, 0, 0},  {0, step, 0},
                                      {0, -step, 0}, {0, 0, turn()}, {0, 0, -turn()}};
  for (int direction = kAhead; direction < static_cast<int>(std::size(displacements));
       ++direction) {
    StrideTo(node, direction, displacements[direction], 0);
  }
}

void LatticeSearch::Change(int node) {
  const GroundedStance from = nodes_[node].stance;
  for (const LocomotionModel::TransitionEntry& transition : space_.model->transitions) {
    const PlanarPose& d = transition.displacement;
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
    Offer(node, next, next.gait, transition.ExpectedDuration());
  }
}

/// Goes straight to a goal that is near.
void LatticeSearch::Finish(int node) {
  const GroundedStance from = nodes_[node].stance;
  for (const GroundedStance& goal : goals_) {
    const PlanarPose left = from.pose.Inverse() * goal.pose;
    if (goal.gait != from.gait || std::abs(goal.z - from.z) > 1e-6) continue;
    if (left.position().norm() > 2 * settings_.step) continue;
    const PlanarPose way{left.x, left.y, WrapAngle(left.yaw)};
    const double duration = StopTime(node, kNone) + StrideTime(from.gait, way);
    Push({.stance = goal,
          .parent = node,
          .action = from.gait,
          .cost = nodes_[node].cost + duration,
          .is_goal = true});
  }
}

void LatticeSearch::Manoeuvres(int node) {
  for (std::size_t i = 0; i < space_.manoeuvres->size(); ++i) {
    const SearchedManoeuvre& manoeuvre = *(*space_.manoeuvres)[i];
    if (manoeuvre.from() != nodes_[node].stance.gait) continue;
    const graph::Point v = PointOf(nodes_[node].stance);
    const std::optional<graph::Point> launch =
        manoeuvre.FindLaunchPoint(v, PointAhead(node, kMostAhead));
    if (!launch) continue;
    if ((*launch - v).norm() > graph::kSamePointDistance) {
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

/// Goes straight to the launch of a manoeuvre.
void LatticeSearch::WalkTo(const graph::Point& launch, int node) {
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

graph::Point LatticeSearch::PointAhead(int node, double distance) const {
  GroundedStance ahead = nodes_[node].stance;
  ahead.pose = ahead.pose * PlanarPose{distance, 0, 0};
  return PointOf(ahead);
}

bool LatticeSearch::Launches(const SearchedManoeuvre& manoeuvre, const graph::Point& v,
                             const graph::Point& end) const {
  const std::optional<graph::Point> launch = manoeuvre.FindLaunchPoint(v, end);
  return launch && (*launch - v).norm() < graph::kSamePointDistance;
}

/// Possible landings of a manoeuvre straight ahead from a node, far ones first.
std::vector<graph::Point> LatticeSearch::Landings(int node,
                                                  const SearchedManoeuvre& manoeuvre) const {
  std::vector<graph::Point> landings;
  const graph::Point v = PointOf(nodes_[node].stance);
  for (double distance = kMostAhead; distance > kLeastAhead - graph::kSamePointDistance;) {
    graph::Point end = manoeuvre.ExtendTowards(v, PointAhead(node, distance));
    const double length = (end - v).head<2>().norm();
    if (length < graph::kSamePointDistance) break;
    if (landings.empty() || (landings.back() - end).norm() > graph::kSamePointDistance)
      landings.push_back(end);
    distance = std::min(distance, length) - kAheadStep;
  }
  return landings;
}

std::vector<GroundedStance> LatticeSearch::Reached() const {
  std::vector<GroundedStance> stances;
  for (const int node : reached_) stances.push_back(nodes_[node].stance);
  return stances;
}

std::vector<graph::PathEdge> LatticeSearch::RouteToNode(int node) const {
  std::vector<int> way;
  for (; node >= 0; node = nodes_[node].parent) way.push_back(node);
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

/// Last node of the straight part of `way` that begins with nodes `first` - 1 and `first`.
std::size_t LatticeSearch::EndOfStraight(const std::vector<int>& way, std::size_t first) const {
  const auto stance = [&](std::size_t i) { return nodes_[way[i]].stance; };
  const auto is_stride = [&](std::size_t i) {
    return nodes_[way[i]].action == stance(i).gait && stance(i).gait == stance(i - 1).gait &&
           std::abs(stance(i).pose.yaw - stance(i - 1).pose.yaw) < graph::kSamePointDistance;
  };
  const auto direction = [&](std::size_t i) {
    return (stance(i).pose.position() - stance(i - 1).pose.position()).normalized();
  };
  std::size_t last = first;
  while (last + 1 < way.size() && is_stride(last) && is_stride(last + 1) &&
         (direction(last + 1) - direction(first)).norm() < graph::kSamePointDistance) {
    ++last;
  }
  return last;
}

graph::PathEdge LatticeSearch::EdgeBetween(int from, int to) const {
  return {nodes_[to].action, {PointOf(nodes_[from].stance), PointOf(nodes_[to].stance)}};
}

}  // namespace possibility::actions
