#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre.h"
#include "actions/flood/route_flood.h"
#include "actions/plan/plan.h"
#include "common/cancellation_token.h"
#include "graph/search/find_path.h"

namespace possibility::actions {

/// Decides whether a route can exist at all; called by the search once cycles have found none. The
/// flood over C_S bounds what these actions could confirm, the flood over C_N what any motion could
/// do.
class FloodOracle {
 public:
  /// All references must outlive the oracle; `manoeuvres` may be filled later. `resolution`: cell
  /// size, m. `cancellation` cancels at the time limit.
  FloodOracle(const LocomotionModel& model, const World& world,
              const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres, double resolution,
              CancellationToken cancellation);

  /// Replaces guessed bounds of manoeuvres before a "no". kUnknown at the time limit.
  graph::RouteOracleAnswer Ask(const GroundedStance& start,
                               const std::vector<GroundedStance>& goals);

  /// Whether the last answer was a "no".
  bool has_barrier() const { return flood_ && !flood_->route_may_exist; }
  /// After kUnknown: the middles of the cells of a way that the finest flood considers open.
  std::vector<GroundedStance> way() const {
    return flood_ ? flood_->way : std::vector<GroundedStance>();
  }
  /// The barrier, after a "no".
  const Barrier& barrier() const { return flood_->barrier; }

  /// After "no": the narrowest place of a way that would be open with relaxed needs. After
  /// kUnknown: the narrowest place of the way that the finest flood considers open. None if there
  /// is no such place, or time runs out. Found when first asked after "exhausted": that can take as
  /// long as the floods.
  const std::optional<NarrowPassage>& passage();

 private:
  graph::RouteOracleAnswer Answer(const GroundedStance& start,
                                  const std::vector<GroundedStance>& goals);
  FloodResult CoarseToFine(const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           const std::vector<FloodManoeuvre>& manoeuvres) const;
  FloodLimits Limits(std::int64_t most_judged = FloodLimits::kMostNodes) const;
  std::optional<std::vector<FloodManoeuvre>> FloodManoeuvres() const;
  std::optional<std::vector<FlightBounds>> Flights() const;
  bool ReplaceGuesses();

  const LocomotionModel& model_;
  const World& world_;
  const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres_;
  double resolution_;
  CancellationToken cancellation_;
  std::optional<NarrowPassage> passage_;
  std::function<std::optional<NarrowPassage>()> find_passage_;  ///< empty once done
  std::optional<FloodResult> flood_;  ///< the last one over C_S, or the one that proved "no"
};

}  // namespace possibility::actions
