#pragma once

#include <optional>
#include <vector>

#include "actions/route/route_space.h"
#include "graph/structure/path_edge.h"

namespace possibility::actions {

/// A stance of a route.
struct RouteStop {
  GroundedStance stance;
  /// The route's edge from the previous stop; without an action for the first stop.
  graph::PathEdge edge;
};

/// A place where the robot can stand in one gait, with any heading.
struct Place {
  int gait = 0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  double z = 0;
};

enum class Validity { kUnknown, kClear, kBlocked };

/// A way from one place to another.
struct Hop {
  int from = 0;
  int to = 0;
  double start_yaw = 0;
  double end_yaw = 0;
  double duration = 0;  ///< expected, s
  Validity validity = Validity::kUnknown;
  std::vector<graph::PathEdge> edges = {};
};

/// Possible end of a route: a place and a heading.
struct Finish {
  int place = 0;
  double yaw = 0;
};

/// Places of a route, and the ways between them that may be quicker than the route: straight from
/// one of its stances to a later one, with their own headings or heading forward or backward, in
/// the gait of both or with transitions at one or both ends. The search adds the turns on the spot.
/// Manoeuvres stay unchanged.
class ShortcutRoadmap {
 public:
  /// `stops`: at least one, end to end. `goals`: alternatives to the last stop, may be empty.
  ShortcutRoadmap(const RouteSpace& space, const std::vector<RouteStop>& stops,
                  const std::vector<GroundedStance>& goals);

  const std::vector<Place>& places() const { return places_; }
  const std::vector<Hop>& hops() const { return hops_; }
  std::vector<Hop>& hops() { return hops_; }
  const std::vector<Finish>& finishes() const { return finishes_; }
  bool has_manoeuvres() const { return has_manoeuvres_; }

  /// A turn on the spot; without duration and edges if the headings are equal.
  Hop Turn(int place, double from_yaw, double to_yaw) const;
  /// Its duration alone, s.
  double TurnDuration(int place, double from_yaw, double to_yaw) const;

 private:
  void AddPlaces();
  void AddPlacesWithin(const GroundedStance& from, const GroundedStance& to, int parts);
  void AddFoundHops();
  void AddDirectHops();
  void AddHopsBetween(int i, int j);
  void AddStraightHop(int i, int j, double yaw);
  void AddExcursion(int i, int j, double yaw, int gait);
  void AddHopsThatEndElsewhere(int i, int j);
  void AddHop(Hop hop, const std::vector<GroundedStance>& stances);

  /// Displacement of the stance by the transition between two gaits; none if there is no
  /// transition.
  std::optional<PlanarPose> Displacement(int from_gait, int to_gait) const;
  /// The edge between two stances; none if they are the same.
  std::optional<graph::PathEdge> EdgeBetween(const GroundedStance& from,
                                             const GroundedStance& to) const;
  GroundedStance StanceAt(int place, double yaw) const;

  RouteSpace space_;
  const std::vector<RouteStop>& stops_;
  const std::vector<GroundedStance>& goals_;
  std::vector<Place> places_;
  std::vector<int> place_of_stop_;
  std::vector<Hop> hops_;
  std::vector<Finish> finishes_;
  bool has_manoeuvres_ = false;
};

}  // namespace possibility::actions
