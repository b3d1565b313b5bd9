#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "actions/route/route.h"
#include "actions/route/route_space.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Proposes routes that are expected to be quicker than all proposed before: the best one after
/// small changes (RoutePolish), then other routes after such changes, one by one.
class RouteImprovement {
 public:
  /// Another confirmed route; empty if none is found. The number counts the calls.
  using Explore = std::function<Route(std::uint64_t round)>;

  /// `route`: the first one, confirmed. What `space` points to must outlive this.
  RouteImprovement(const RouteSpace& space, Route route, std::uint64_t seed, Explore explore);

  /// The next route; none once cancelled.
  std::optional<Route> Next(const CancellationToken& cancellation);
  /// Reports that a route became the best plan: changes begin with it.
  void Accept(const Route& route) { best_ = route; }

 private:
  Route Polished(const Route& route, const CancellationToken& cancellation);

  RouteSpace space_;
  Route best_;
  double least_expected_;  ///< s, of all that were proposed
  std::uint64_t seed_;
  std::uint64_t round_ = 0;
  Explore explore_;
};

}  // namespace possibility::actions
