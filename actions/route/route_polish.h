#pragma once

#include <cstdint>
#include <vector>

#include "actions/route/route.h"
#include "actions/route/route_space.h"
#include "common/cancellation_token.h"
#include "graph/action/random.h"

namespace possibility::actions {

/// Makes a route quicker by small random changes that C_S allows: places where two straight ways
/// meet are moved, left out or added, and transitions are moved together with the ends of the ways
/// beside them. Manoeuvres stay where they are, because their jobs have confirmed them there. One
/// seed always gives the same changes.
class RoutePolish {
 public:
  /// `route`: end to end, confirmed. What `space` points to must outlive the polish.
  RoutePolish(const RouteSpace& space, Route route, std::uint64_t seed);

  /// Tries `tries` changes, and keeps those that are expected to be quicker. Returns whether there
  /// was one. Asks `cancellation` before each.
  bool Try(int tries, const CancellationToken& cancellation);

  const Route& route() const { return route_; }

 private:
  bool IsWay(std::size_t leg) const;
  bool Holds(const RouteLeg& leg) const;
  bool TryOne();
  PlanarPose Change();
  bool MoveMeeting(std::size_t leg);
  bool LeaveOutMeeting(std::size_t leg);
  bool AddMeeting(std::size_t leg);
  bool MoveTransition(std::size_t leg);
  bool Replace(std::size_t first, std::size_t count, const Route& legs);

  RouteSpace space_;
  Route route_;
  graph::RandomGenerator generator_;
};

}  // namespace possibility::actions
