#pragma once

#include <string>
#include <vector>

#include "actions/route/route_space.h"
#include "graph/search/explorer.h"

namespace possibility::actions {

/// Proposes quicker ways through the places of the confirmed route (FindShortcuts), and repeats
/// until there is no gain.
class ShortcutExplorer : public graph::Explorer {
 public:
  ShortcutExplorer(const RouteSpace& space, const std::vector<GroundedStance>& goals,
                   const graph::ExplorerContext& context);

  std::string name() const override { return "shortcuts"; }
  bool TakesPart(graph::SearchStage stage) const override {
    return stage == graph::SearchStage::kImprovement;
  }
  graph::Findings Explore() override;
  double work_of_turn() const override { return 10e-3; }
  bool OnRoute(const std::vector<graph::PathEdge>& route, double duration) override;

 private:
  double DurationOf(const std::vector<graph::PathEdge>& route) const;

  RouteSpace space_;
  std::vector<GroundedStance> goals_;
  graph::ExplorerContext context_;
  std::vector<graph::PathEdge> route_;
};

/// Makes a ShortcutExplorer. What `space` points to must outlive the search.
graph::ExplorerFactory ShortcutExploration(const RouteSpace& space,
                                           const std::vector<GroundedStance>& goals);

}  // namespace possibility::actions
