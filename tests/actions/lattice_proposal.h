#pragma once

#include <vector>

#include "actions/route/lattice_explorer.h"
#include "common/deadline.h"

namespace possibility::actions {

/// The first proposal of a LatticeExplorer; empty if its lattices find nothing.
inline std::vector<graph::PathEdge> FirstProposal(const RouteSpace& space,
                                                  const GroundedStance& start,
                                                  const std::vector<GroundedStance>& goals) {
  const Deadline deadline(600);
  const graph::ExplorerContext context{.deadline = &deadline};
  LatticeExplorer explorer(space, start, goals, context);
  for (;;) {
    graph::Findings findings = explorer.Explore();
    if (!findings.route.empty() || findings.outlook == graph::Outlook::kOver) {
      return findings.route;
    }
  }
}

}  // namespace possibility::actions
