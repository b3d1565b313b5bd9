#include "actions/route/shortcut_roadmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "graph/structure/vertex_index.h"

namespace possibility::actions {
namespace {

/// Largest number of places: the cost of a search grows with their cube.
constexpr std::size_t kMostStops = 32;

/// Spacing of places within legs of the route, m.
constexpr double kPlaceSpacing = 0.4;

bool SameHeading(double a, double b) {
  return std::abs(WrapAngle(b - a)) < graph::kSamePointDistance;
}

bool SameHeight(double a, double b) { return std::abs(a - b) < graph::kSamePointDistance; }

}  // namespace

ShortcutRoadmap::ShortcutRoadmap(const RouteSpace& space, const std::vector<RouteStop>& stops,
                                 const std::vector<GroundedStance>& goals)
    : space_(space), stops_(stops), goals_(goals) {
  AddPlaces();
  AddFoundHops();
  AddDirectHops();
  const int first_goal = static_cast<int>(places_.size() - goals_.size());
  for (int i = 0; i < first_goal; ++i) {
    for (int j = i + 1; j < static_cast<int>(places_.size()); ++j) AddHopsBetween(i, j);
  }
}

void ShortcutRoadmap::AddPlaces() {
  const std::size_t room = kMostStops - std::min(kMostStops, stops_.size());
  double length = 0;
  for (std::size_t i = 1; i < stops_.size(); ++i) {
    length += (stops_[i].stance.pose.position() - stops_[i - 1].stance.pose.position()).norm();
  }
  const double spacing = std::max(kPlaceSpacing, length / static_cast<double>(room + 1));
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const GroundedStance& stance = stops_[i].stance;
    if (i > 0 && stops_[i - 1].stance.gait == stance.gait &&
        SameHeight(stops_[i - 1].stance.z, stance.z)) {
      const GroundedStance& before = stops_[i - 1].stance;
      const double leg = (stance.pose.position() - before.pose.position()).norm();
      AddPlacesWithin(before, stance, static_cast<int>(leg / spacing));
    }
    place_of_stop_.push_back(static_cast<int>(places_.size()));
    places_.push_back({stance.gait, stance.pose.position(), stance.z});
  }
  finishes_.push_back({place_of_stop_.back(), stops_.back().stance.pose.yaw});
  for (const GroundedStance& goal : goals_) {
    finishes_.push_back({static_cast<int>(places_.size()), goal.pose.yaw});
    places_.push_back({goal.gait, goal.pose.position(), goal.z});
  }
}

void ShortcutRoadmap::AddPlacesWithin(const GroundedStance& from, const GroundedStance& to,
                                      int parts) {
  for (int part = 1; part < parts; ++part) {
    const double s = static_cast<double>(part) / parts;
    places_.push_back({from.gait, Interpolate(from.pose, to.pose, s).position(), from.z});
  }
}

void ShortcutRoadmap::AddFoundHops() {
  for (std::size_t i = 1; i < stops_.size(); ++i) {
    const graph::PathEdge& edge = stops_[i].edge;
    const int gaits = static_cast<int>(space_.gaits->size());
    const bool is_manoeuvre = edge.action >= gaits;
    has_manoeuvres_ = has_manoeuvres_ || is_manoeuvre;
    Hop hop;
    hop.from = place_of_stop_[i - 1];
    hop.to = place_of_stop_[i];
    hop.start_yaw = stops_[i - 1].stance.pose.yaw;
    hop.end_yaw = stops_[i].stance.pose.yaw;
    hop.duration = is_manoeuvre
                       ? (*space_.manoeuvres)[edge.action - gaits]->ExpectedDuration(edge.points)
                       : (*space_.gaits)[edge.action]->ExpectedDuration(edge.points);
    hop.validity = Validity::kClear;
    hop.edges = {edge};
    hops_.push_back(std::move(hop));
  }
}

/// Connects pairs of stances directly: the route between them may be a detour.
void ShortcutRoadmap::AddDirectHops() {
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    for (std::size_t j = i + 2; j < stops_.size(); ++j) {
      const GroundedStance& a = stops_[i].stance;
      const GroundedStance& b = stops_[j].stance;
      if (a.gait != b.gait || !SameHeight(a.z, b.z)) continue;
      AddHop({.from = place_of_stop_[i], .to = place_of_stop_[j]}, {a, b});
    }
  }
}

void ShortcutRoadmap::AddHopsBetween(int i, int j) {
  if (!SameHeight(places_[i].z, places_[j].z)) return;
  if (places_[i].gait != places_[j].gait) {
    AddHopsThatEndElsewhere(i, j);
    return;
  }
  const Eigen::Vector2d way = places_[j].p - places_[i].p;
  if (way.norm() < graph::kSamePointDistance) return;
  const double heading = std::atan2(way.y(), way.x());
  for (const double yaw : {heading, heading + std::numbers::pi}) {
    AddStraightHop(i, j, yaw);
    for (int gait = 0; gait < static_cast<int>(space_.gaits->size()); ++gait) {
      if (gait != places_[i].gait) AddExcursion(i, j, yaw, gait);
    }
  }
}

void ShortcutRoadmap::AddStraightHop(int i, int j, double yaw) {
  AddHop({.from = i, .to = j}, {StanceAt(i, yaw), StanceAt(j, yaw)});
}

/// Adds a hop in another gait, with a transition before and one after.
void ShortcutRoadmap::AddExcursion(int i, int j, double yaw, int gait) {
  const std::optional<PlanarPose> displacement = Displacement(places_[i].gait, gait);
  if (!displacement) return;
  const GroundedStance a = StanceAt(i, yaw);
  const GroundedStance d = StanceAt(j, yaw);
  const GroundedStance b{gait, a.pose * *displacement, a.z};
  const GroundedStance c{gait, d.pose * *displacement, a.z};
  AddHop({.from = i, .to = j}, {a, b, c, d});
}

/// Adds hops between places of two gaits: a transition and then straight on, or straight on and
/// then a transition. Let e be the displacement of the transition in the frame of the stance that
/// moves on, e' that of the opposite transition, and s the length of the way. The way between the
/// places is R(yaw) (e + (s, 0)) in the first case and R(yaw) ((s, 0) - e') in the second.
void ShortcutRoadmap::AddHopsThatEndElsewhere(int i, int j) {
  const Eigen::Vector2d way = places_[j].p - places_[i].p;
  const double direction = std::atan2(way.y(), way.x());
  const auto headings = [&](const Eigen::Vector2d& e) {
    std::vector<double> yaws;
    const double along = way.squaredNorm() - e.y() * e.y();
    if (along < 0) return yaws;
    for (const double x : {std::sqrt(along), -std::sqrt(along)}) {
      yaws.push_back(direction - std::atan2(e.y(), x));
    }
    return yaws;
  };
  if (const auto d = Displacement(places_[i].gait, places_[j].gait)) {
    for (const double yaw : headings(Eigen::Rotation2Dd(-d->yaw) * d->position())) {
      const GroundedStance a = StanceAt(i, yaw - d->yaw);
      const GroundedStance b{places_[j].gait, a.pose * *d, a.z};
      AddHop({.from = i, .to = j}, {a, b, StanceAt(j, yaw)});
    }
  }
  if (const auto d = Displacement(places_[j].gait, places_[i].gait)) {
    for (const double yaw : headings(-(Eigen::Rotation2Dd(-d->yaw) * d->position()))) {
      const GroundedStance c = StanceAt(j, yaw - d->yaw);
      const GroundedStance b{places_[i].gait, c.pose * *d, c.z};
      AddHop({.from = i, .to = j}, {StanceAt(i, yaw), b, c});
    }
  }
}

void ShortcutRoadmap::AddHop(Hop hop, const std::vector<GroundedStance>& stances) {
  hop.start_yaw = stances.front().pose.yaw;
  hop.end_yaw = stances.back().pose.yaw;
  for (std::size_t i = 1; i < stances.size(); ++i) {
    const auto edge = EdgeBetween(stances[i - 1], stances[i]);
    if (!edge) continue;
    hop.duration += (*space_.gaits)[edge->action]->ExpectedDuration(edge->points);
    hop.edges.push_back(*edge);
  }
  hops_.push_back(std::move(hop));
}

Hop ShortcutRoadmap::Turn(int place, double from_yaw, double to_yaw) const {
  Hop turn{.from = place, .to = place, .start_yaw = from_yaw, .end_yaw = to_yaw};
  if (SameHeading(from_yaw, to_yaw)) return turn;
  turn.duration = TurnDuration(place, from_yaw, to_yaw);
  turn.edges = {*EdgeBetween(StanceAt(place, from_yaw), StanceAt(place, to_yaw))};
  return turn;
}

double ShortcutRoadmap::TurnDuration(int place, double from_yaw, double to_yaw) const {
  if (SameHeading(from_yaw, to_yaw)) return 0;
  return (*space_.gaits)[places_[place].gait]->ExpectedDuration(StanceAt(place, from_yaw).pose,
                                                                StanceAt(place, to_yaw).pose);
}

std::optional<PlanarPose> ShortcutRoadmap::Displacement(int from_gait, int to_gait) const {
  for (const LocomotionModel::TransitionEntry& transition : space_.model->transitions) {
    const PlanarPose& displacement = transition.displacement;
    if (transition.from == from_gait && transition.to == to_gait) return displacement;
    if (transition.to == from_gait && transition.from == to_gait) return displacement.Inverse();
  }
  return std::nullopt;
}

std::optional<graph::PathEdge> ShortcutRoadmap::EdgeBetween(const GroundedStance& from,
                                                            const GroundedStance& to) const {
  const bool same =
      from.gait == to.gait &&
      (from.pose.position() - to.pose.position()).norm() < graph::kSamePointDistance &&
      SameHeading(from.pose.yaw, to.pose.yaw);
  if (same) return std::nullopt;
  const auto point = [&](const GroundedStance& stance) {
    return ToPoint(space_.model->gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
  };
  return graph::PathEdge{to.gait, {point(from), point(to)}};
}

GroundedStance ShortcutRoadmap::StanceAt(int place, double yaw) const {
  return {places_[place].gait, {places_[place].p.x(), places_[place].p.y(), yaw}, places_[place].z};
}

}  // namespace possibility::actions
