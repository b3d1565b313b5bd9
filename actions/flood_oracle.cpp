#include "actions/flood_oracle.h"

#include <cstdint>
#include <iterator>
#include <utility>

#include "actions/dead_end.h"

namespace possibility::actions {

FloodOracle::FloodOracle(const LocomotionModel& model, const World& world,
                         const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                         double resolution, std::function<bool()> keep_going)
    : model_(model),
      world_(world),
      manoeuvres_(manoeuvres),
      resolution_(resolution),
      keep_going_(std::move(keep_going)) {}

graph::RouteOracleAnswer FloodOracle::Ask(const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals) {
  try {
    return Answer(start, goals);
  } catch (const Abandoned&) {
    return graph::RouteOracleAnswer::kUnknown;
  }
}

/// @throws Abandoned at the time limit.
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
    if (flood_->route_may_exist) return graph::RouteOracleAnswer::kUnknown;
  }
  const graph::RouteOracleAnswer otherwise = leads_are_known || dead_end
                                                 ? graph::RouteOracleAnswer::kExhausted
                                                 : graph::RouteOracleAnswer::kUnknown;
  const std::optional<std::vector<FlightBounds>> flights = Flights();
  if (!flights) return otherwise;
  FloodResult necessary =
      FloodNecessary(model_, world_, start, goals, resolution_, keep_going_, *flights);
  if (necessary.route_may_exist) return otherwise;
  if (flood_) {
    std::move(flood_->barrier.reached.begin(), flood_->barrier.reached.end(),
              std::back_inserter(necessary.barrier.reached));
  }
  flood_ = std::move(necessary);
  return graph::RouteOracleAnswer::kProvenInfeasible;
}

/// The flood over C_S; a finer one, as far as it gets, where coarse cells find no barrier.
FloodResult FloodOracle::CoarseToFine(const GroundedStance& start,
                                      const std::vector<GroundedStance>& goals,
                                      const std::vector<FloodManoeuvre>& manoeuvres) const {
  constexpr int kHalvings = 3;
  constexpr std::int64_t kMostCells = 500000;  // no limit of time: the same answer anywhere
  FloodResult coarse =
      FloodSufficient(model_, world_, start, goals, resolution_, keep_going_, manoeuvres);
  if (!coarse.route_may_exist) return coarse;
  std::int64_t cells = 0;
  return FloodSufficient(
      model_, world_, start, goals, resolution_,
      [&] { return ++cells <= kMostCells && keep_going_(); }, manoeuvres, kHalvings);
}

/// Nothing if some manoeuvre does not say where it leads: then no closed barrier is a proof.
std::optional<std::vector<FloodManoeuvre>> FloodOracle::FloodManoeuvres() const {
  std::vector<FloodManoeuvre> result;
  for (const auto& manoeuvre : manoeuvres_) {
    ManoeuvreBounds bounds = manoeuvre->Bounds();
    if (!bounds.landings) return std::nullopt;
    result.push_back({manoeuvre->from(), manoeuvre->to(), std::move(bounds.landings)});
  }
  return result;
}

/// Nothing if some manoeuvre does not say how it flies.
std::optional<std::vector<FlightBounds>> FloodOracle::Flights() const {
  std::vector<FlightBounds> result;
  for (const auto& manoeuvre : manoeuvres_) {
    const std::optional<FlightBounds> flight = manoeuvre->Bounds().flight;
    if (!flight) return std::nullopt;
    result.push_back(*flight);
  }
  return result;
}

/// Whether any has changed. @throws Abandoned at the time limit.
bool FloodOracle::ReplaceGuesses() {
  bool replaced = false;
  for (const auto& manoeuvre : manoeuvres_) {
    replaced = manoeuvre->ReplaceGuesses(keep_going_) || replaced;
  }
  return replaced;
}

}  // namespace possibility::actions
