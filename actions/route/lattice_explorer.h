#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "actions/route/lattice_search.h"
#include "graph/search/explorer.h"

namespace possibility::actions {

/// Settings for the search of a first route, in order: coarse and greedy lattices first.
std::span<const LatticeSettings> FirstRouteLadder();

/// Settings for the search of a quicker route than a known one: patient.
std::span<const LatticeSettings> ImprovementLadder();

/// Proposes routes found on lattices, one lattice after the other. If jobs refute edges of a route,
/// its lattice is searched again. Once a route is confirmed, the explorer searches for quicker
/// ones.
class LatticeExplorer : public graph::Explorer {
 public:
  LatticeExplorer(const RouteSpace& space, const GroundedStance& start,
                  const std::vector<GroundedStance>& goals, const graph::ExplorerContext& context);

  std::string name() const override { return "lattice"; }
  bool TakesPart(graph::SearchStage) const override { return true; }
  graph::Findings Explore() override;
  double work_of_turn() const override { return kWorkOfTurn; }
  bool OnRefuted() override;
  bool OnRoute(const std::vector<graph::PathEdge>& route, double duration) override;
  double lower_bound() const override { return lower_bound_; }

 private:
  static constexpr double kWorkOfTurn = 5e-3;  ///< s

  graph::Findings Propose();
  graph::Findings NextLattice();
  graph::Outlook OutlookOfSearch();

  RouteSpace space_;
  GroundedStance start_;
  std::vector<GroundedStance> goals_;
  const Deadline* deadline_;
  std::span<const LatticeSettings> ladder_;
  std::size_t rung_ = 0;
  std::optional<LatticeSearch> search_;  ///< under way
  double bound_ = 0;                     ///< s, of the known route; 0: none
  double lower_bound_ = 0;               ///< s
  double closest_ = 0;                   ///< m, of the search under way
  int turns_without_progress_ = 0;
  int proposals_ = 0;
};

/// Makes a LatticeExplorer. What `space` points to must outlive the search.
graph::ExplorerFactory LatticeExploration(const RouteSpace& space, const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals);

}  // namespace possibility::actions
