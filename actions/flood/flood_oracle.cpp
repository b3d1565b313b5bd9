#include "actions/flood/flood_oracle.h"

#include <iterator>
#include <utility>

#include "actions/flood/dead_end.h"
#include "actions/flood/necessary_flood.h"
#include "actions/flood/passage_gauge.h"
#include "actions/flood/passage_search.h"
#include "actions/flood/sufficient_flood.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

FloodOracle::FloodOracle(const LocomotionModel& model, const World& world,
                         const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                         double resolution, CancellationToken cancellation)
    : model_(model),
      world_(world),
      manoeuvres_(manoeuvres),
      resolution_(resolution),
      cancellation_(std::move(cancellation)) {}

graph::RouteOracleAnswer FloodOracle::Ask(const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals) {
  try {
    return Answer(start, goals);
  } catch (const Cancelled&) {
    return graph::RouteOracleAnswer::kUnknown;
  }
}

/// @throws Cancelled at the time limit.
graph::RouteOracleAnswer FloodOracle::Answer(const GroundedStance& start,
                                             const std::vector<GroundedStance>& goals) {
  std::optional<std::vector<FloodManoeuvre>> manoeuvres = FloodManoeuvres();
  const bool leads_are_known = manoeuvres.has_value();
  const std::optional<FloodResult> dead_end =
      FindDeadEnd(model_, world_, manoeuvres_, start, goals);
  if (dead_end) {
    flood_ = dead_end;
  } else if (leads_are_known) {
    flood_ = CoarseToFine(start, goals, *manoeuvres);
    if (!flood_->route_may_exist && ReplaceGuesses()) {
      manoeuvres = FloodManoeuvres();
      if (!manoeuvres) return graph::RouteOracleAnswer::kUnknown;
      flood_ = CoarseToFine(start, goals, *manoeuvres);
    }
    if (flood_->route_may_exist) {
      passage_ = PassageGauge(model_, world_, *manoeuvres).Narrowest(flood_->way, cancellation_);
      return graph::RouteOracleAnswer::kUnknown;
    }
  }
  const graph::RouteOracleAnswer otherwise = leads_are_known || dead_end
                                                 ? graph::RouteOracleAnswer::kExhausted
                                                 : graph::RouteOracleAnswer::kUnknown;
  if (leads_are_known) {
    find_passage_ = [this, start, goals, manoeuvres = *manoeuvres] {
      return SearchPassage(model_, world_, start, goals, resolution_, manoeuvres, cancellation_);
    };
  }
  const std::optional<std::vector<FlightBounds>> flights = Flights();
  if (!flights) return otherwise;
  FloodResult necessary =
      FloodNecessary(model_, world_, start, goals, resolution_, Limits(), *flights);
  if (necessary.route_may_exist) return otherwise;
  find_passage_ = {};  // after a proof no way is left to examine
  if (flood_) {
    std::move(flood_->barrier.reached.begin(), flood_->barrier.reached.end(),
              std::back_inserter(necessary.barrier.reached));
  }
  flood_ = std::move(necessary);
  return graph::RouteOracleAnswer::kProvenInfeasible;
}

const std::optional<NarrowPassage>& FloodOracle::passage() {
  if (const auto find = std::exchange(find_passage_, {})) {
    try {
      passage_ = find();
    } catch (const Cancelled&) {  // the answer stands without
    }
  }
  return passage_;
}

/// The flood over C_S. If coarse cells find no barrier, finer floods follow within their limits: a
/// flood that finds a way ends quickly.
FloodResult FloodOracle::CoarseToFine(const GroundedStance& start,
                                      const std::vector<GroundedStance>& goals,
                                      const std::vector<FloodManoeuvre>& manoeuvres) const {
  constexpr int kMostHalvings = 3;
  constexpr std::int64_t kMostJudged = 4'000'000;  // no time limit: same answer anywhere
  FloodResult flood;
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings) {
    flood = FloodSufficient(model_, world_, start, goals,
                            {.resolution = resolution_, .halvings = halvings}, Limits(kMostJudged),
                            manoeuvres);
    if (!flood.route_may_exist || flood.is_cut_short) break;
  }
  return flood;
}

FloodLimits FloodOracle::Limits(std::int64_t most_judged) const {
  return {.most_judged = most_judged, .cancellation = cancellation_};
}

/// None if some manoeuvre does not declare its landings: then a closed barrier is no proof.
std::optional<std::vector<FloodManoeuvre>> FloodOracle::FloodManoeuvres() const {
  std::vector<FloodManoeuvre> result;
  for (const auto& manoeuvre : manoeuvres_) {
    ManoeuvreBounds bounds = manoeuvre->Bounds();
    if (!bounds.landings) return std::nullopt;
    result.push_back(
        {manoeuvre->from(), manoeuvre->to(), std::move(bounds.landings), manoeuvre->name()});
  }
  return result;
}

/// None if some manoeuvre does not declare its flight.
std::optional<std::vector<FlightBounds>> FloodOracle::Flights() const {
  std::vector<FlightBounds> result;
  for (const auto& manoeuvre : manoeuvres_) {
    const std::optional<FlightBounds> flight = manoeuvre->Bounds().flight;
    if (!flight) return std::nullopt;
    result.push_back(*flight);
  }
  return result;
}

/// Returns whether any bound has changed. @throws Cancelled at the time limit.
bool FloodOracle::ReplaceGuesses() {
  bool replaced = false;
  for (const auto& manoeuvre : manoeuvres_) {
    replaced = manoeuvre->ReplaceGuesses(cancellation_) || replaced;
  }
  return replaced;
}

}  // namespace possibility::actions
