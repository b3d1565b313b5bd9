#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/footholds/foothold_flood.h"
#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/route/lattice_search.h"
#include "actions/route/route_space.h"
#include "graph/search/explorer.h"

namespace possibility::actions {

/// Proposes routes that need both: actions whose conditions a lattice knows, and planned steps.
/// What a lattice reaches from one stance is an island. Where it holds no goal, footsteps are
/// searched from anywhere on it to stances that meet C_S beyond it, close to a goal if possible.
/// From there a lattice explores the next island. If jobs refute edges of a route, the search
/// begins anew without them. Failure proves nothing.
class IslandExplorer : public graph::Explorer {
 public:
  /// `lattice`: gaits, transitions and manoeuvres. `steps`: of some gait; `action`: its number
  /// among the search's actions. Takes part once `*is_called` and `*is_alone`: steps alone do not
  /// do. All but `start` and `goals` must outlive the search.
  IslandExplorer(const RouteSpace& lattice, const PlannedSteps& steps, int action,
                 const GroundedStance& start, const std::vector<GroundedStance>& goals,
                 const bool* is_called, const bool* is_alone,
                 const graph::ExplorerContext& context);

  std::string name() const override { return "footsteps"; }
  bool TakesPart(graph::SearchStage stage) const override {
    return *is_called_ && *is_alone_ && stage == graph::SearchStage::kFirstRoute;
  }
  graph::Findings Explore() override;
  double work_of_turn() const override { return kWorkOfTurn; }
  bool OnRefuted() override;

 private:
  static constexpr double kWorkOfTurn = 10e-3;  ///< s

  struct Island {
    GroundedStance entry;
    std::unique_ptr<LatticeSearch> island;
    std::ptrdiff_t edges = 0;  ///< of the route up to its entry
  };

  const QuasiStaticAction& gait() const { return *(*lattice_.gaits)[steps_.from()]; }
  graph::Findings ExploreIsland(const CancellationToken& cancellation);
  graph::Findings LeaveIsland(const CancellationToken& cancellation);
  graph::Findings CrossTo(const GroundedStance& from, const GroundedStance& to);
  void Remember();
  /// To the last island that leads elsewhere, too.
  graph::Findings GoBack(const CancellationToken& cancellation);
  bool BeginToLeave(const CancellationToken& cancellation);
  std::vector<GroundedStance> StancesBeyond(const CancellationToken& cancellation) const;
  /// Only what is nearer to a goal than all that is `reached`.
  void KeepNearer(const std::vector<GroundedStance>& reached);
  void DropUnreachable(const std::vector<GroundedStance>& starts,
                       const CancellationToken& cancellation);
  bool IsKnown(const GroundedStance& stance) const;
  double TimeLeft(const GroundedStance& stance) const;

  RouteSpace lattice_;
  const PlannedSteps& steps_;
  int action_;
  std::vector<GroundedStance> goals_;
  const bool* is_called_;
  const bool* is_alone_;
  const Deadline* deadline_;
  std::int64_t* islands_;  ///< counter
  std::int64_t* states_;   ///< counter
  GroundedStance start_;
  GroundedStance entry_;                ///< of the island
  std::vector<graph::PathEdge> route_;  ///< from the start to the entry
  std::unique_ptr<LatticeSearch> island_;
  std::vector<Island> earlier_;          ///< on the way to this one
  std::vector<GroundedStance> reached_;  ///< of all islands that were explored
  std::optional<FootstepSearch> crossing_;
  std::optional<FootholdFlood> flood_;  ///< from the island left last
  std::vector<GroundedStance> beyond_;  ///< goals of the crossing
  bool is_over_ = false;
  int proposals_ = 0;
};

/// Makes an IslandExplorer.
graph::ExplorerFactory IslandExploration(const RouteSpace& lattice, const PlannedSteps& steps,
                                         int action, const GroundedStance& start,
                                         const std::vector<GroundedStance>& goals,
                                         const bool* is_called, const bool* is_alone);

}  // namespace possibility::actions
