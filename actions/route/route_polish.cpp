#include "actions/route/route_polish.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace possibility::actions {
namespace {

/// Least gain in duration that is not rounding, s.
constexpr double kGain = 1e-3;
/// Changes of a place: as long as that at most (m), and down to a hundredth of it; likewise turns
/// (rad), in every second change.
constexpr double kFarthest = 1;
constexpr double kShare = 0.01;
constexpr double kWidestTurn = std::numbers::pi / 2;

}  // namespace

RoutePolish::RoutePolish(const RouteSpace& space, Route route, std::uint64_t seed)
    : space_(space), route_(std::move(route)), generator_(seed) {}

bool RoutePolish::Try(int tries, const CancellationToken& cancellation) {
  bool is_quicker = false;
  for (int i = 0; i < tries && !route_.empty() && cancellation.Proceed(); ++i) {
    is_quicker = TryOne() || is_quicker;
  }
  return is_quicker;
}

bool RoutePolish::IsWay(std::size_t leg) const {
  return leg < route_.size() && route_[leg].manoeuvre == nullptr && route_[leg].transition < 0;
}

bool RoutePolish::Holds(const RouteLeg& leg) const {
  const graph::Edge edge = LegEdge(*space_.model, leg);
  if (leg.transition < 0) return (*space_.gaits)[static_cast<std::size_t>(leg.gait)]->CS(edge);
  return std::any_of(space_.gaits->begin(), space_.gaits->end(),
                     [&](const auto& gait) { return gait->CS(edge); });
}

bool RoutePolish::TryOne() {
  const auto leg = static_cast<std::size_t>(graph::UniformIndex(route_.size(), &generator_));
  const bool meets = IsWay(leg) && IsWay(leg + 1) && route_[leg].gait == route_[leg + 1].gait;
  switch (graph::UniformIndex(8, &generator_)) {
    case 0:
      return meets && LeaveOutMeeting(leg);
    case 1:
      return IsWay(leg) && AddMeeting(leg);
    case 2:
    case 3:
    case 4:
      return route_[leg].transition >= 0 && IsWay(leg - 1) && IsWay(leg + 1) && MoveTransition(leg);
    default:
      return meets && MoveMeeting(leg);
  }
}

PlanarPose RoutePolish::Change() {
  const double scale = std::exp(graph::UniformReal(std::log(kShare), 0, &generator_));
  const double direction = graph::UniformReal(-std::numbers::pi, std::numbers::pi, &generator_);
  const double turn = graph::UniformIndex(2, &generator_) == 0
                          ? 0
                          : graph::UniformReal(-kWidestTurn, kWidestTurn, &generator_);
  return {scale * kFarthest * std::cos(direction), scale * kFarthest * std::sin(direction),
          scale * turn};
}

bool RoutePolish::MoveMeeting(std::size_t leg) {
  Route legs = {route_[leg], route_[leg + 1]};
  const PlanarPose change = Change();
  const PlanarPose& place = legs[0].to;
  legs[0].to = legs[1].from =
      PlanarPose{place.x + change.x, place.y + change.y, place.yaw + change.yaw};
  return Replace(leg, 2, legs);
}

bool RoutePolish::LeaveOutMeeting(std::size_t leg) {
  RouteLeg direct = route_[leg];
  direct.to = route_[leg + 1].to;
  direct.z_to = route_[leg + 1].z_to;
  return Replace(leg, 2, {direct});
}

bool RoutePolish::AddMeeting(std::size_t leg) {
  Route legs = {route_[leg], route_[leg]};
  const PlanarPose middle =
      Interpolate(legs[0].from, legs[0].to, graph::UniformReal(0.1, 0.9, &generator_));
  const PlanarPose change = Change();
  legs[0].to = legs[1].from =
      PlanarPose{middle.x + change.x, middle.y + change.y, middle.yaw + change.yaw};
  legs[0].z_to = legs[1].z = legs[0].z;
  return Replace(leg, 1, legs);
}

bool RoutePolish::MoveTransition(std::size_t leg) {
  Route legs = {route_[leg - 1], route_[leg], route_[leg + 1]};
  const PlanarPose passed = legs[1].from.Inverse() * legs[1].to;
  const PlanarPose change = Change();
  const PlanarPose& place = legs[1].from;
  legs[0].to = legs[1].from =
      PlanarPose{place.x + change.x, place.y + change.y, place.yaw + change.yaw};
  legs[1].to = legs[2].from = legs[1].from * passed;
  return Replace(leg - 1, 3, legs);
}

/// Replaces legs by others if those are quicker and C_S holds for them.
bool RoutePolish::Replace(std::size_t first, std::size_t count, const Route& legs) {
  const auto begin = route_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = begin + static_cast<std::ptrdiff_t>(count);
  const double before = ExpectedDuration(*space_.model, Route(begin, end));
  if (!(ExpectedDuration(*space_.model, legs) < before - kGain)) return false;
  const bool holds =
      std::all_of(legs.begin(), legs.end(), [this](const RouteLeg& leg) { return Holds(leg); });
  if (!holds) return false;
  Route route(route_.begin(), begin);
  route.insert(route.end(), legs.begin(), legs.end());
  route.insert(route.end(), end, route_.end());
  route_ = std::move(route);
  return true;
}

}  // namespace possibility::actions
