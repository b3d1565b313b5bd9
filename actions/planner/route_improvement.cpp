#include "actions/planner/route_improvement.h"

#include <utility>

#include "actions/route/route_polish.h"

namespace possibility::actions {
namespace {

/// Gain in expected duration that is worth a motion and its verification, s.
constexpr double kWorthwhile = 0.02;
/// Changes until a look at whether they lead on.
constexpr int kChanges = 2000;
/// Every so many rounds another route is explored; in the others the best one is changed.
constexpr std::uint64_t kRoundsEach = 3;

}  // namespace

RouteImprovement::RouteImprovement(const RouteSpace& space, Route route, std::uint64_t seed,
                                   Explore explore)
    : space_(space),
      best_(std::move(route)),
      least_expected_(ExpectedDuration(*space.model, best_)),
      seed_(seed),
      explore_(std::move(explore)) {}

std::optional<Route> RouteImprovement::Next(const CancellationToken& cancellation) {
  while (!best_.empty() && cancellation.Proceed()) {
    ++round_;
    const Route begin = round_ % kRoundsEach == 0 ? explore_(round_) : best_;
    Route route = Polished(begin, cancellation);
    const double expected = ExpectedDuration(*space_.model, route);
    if (route.empty() || !(expected < least_expected_ - kWorthwhile)) continue;
    least_expected_ = expected;
    return route;
  }
  return std::nullopt;
}

Route RouteImprovement::Polished(const Route& route, const CancellationToken& cancellation) {
  RoutePolish polish(space_, route, seed_ + round_);
  while (polish.Try(kChanges, cancellation)) {
  }
  return polish.route();
}

}  // namespace possibility::actions
