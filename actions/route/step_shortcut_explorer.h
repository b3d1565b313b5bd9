#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/route/route_space.h"
#include "graph/search/explorer.h"

namespace possibility::actions {

/// Proposes planned steps instead of manoeuvres of the confirmed route, where they are quicker: the
/// first route may leap down stairs that can be walked. Takes part once `*is_called`: routes that
/// were found without steps are left alone.
class StepShortcutExplorer : public graph::Explorer {
 public:
  /// `steps`: of some gait; `action`: its number among the search's actions. What `space` points to
  /// and `steps` must outlive the search.
  StepShortcutExplorer(const RouteSpace& space, const PlannedSteps& steps, int action,
                       const bool* is_called, const graph::ExplorerContext& context);

  std::string name() const override { return "footsteps"; }
  bool TakesPart(graph::SearchStage stage) const override {
    return *is_called_ && stage == graph::SearchStage::kImprovement;
  }
  graph::Findings Explore() override;
  double work_of_turn() const override { return 10e-3; }
  bool OnRoute(const std::vector<graph::PathEdge>& route, double duration) override;

 private:
  /// A part of the route between stances of the steps' gait, with manoeuvres.
  struct Stretch {
    GroundedStance from;
    GroundedStance to;
    graph::Edge edge;     ///< the ends
    double duration = 0;  ///< expected, s
  };

  std::vector<Stretch> StretchesOf(const std::vector<graph::PathEdge>& route) const;
  static void AddParts(const std::vector<Stretch>& chain, std::vector<Stretch>* stretches);
  /// @throws Cancelled.
  std::vector<graph::PathEdge> Continue(const CancellationToken& cancellation);

  RouteSpace space_;
  const PlannedSteps& steps_;
  int action_;
  const bool* is_called_;
  graph::ExplorerContext context_;
  std::deque<Stretch> stretches_;  ///< to be searched; the first one is under way
  std::optional<FootstepSearch> search_;
  std::set<std::vector<double>> tried_;  ///< numbers of both ends
};

/// Makes a StepShortcutExplorer.
graph::ExplorerFactory StepShortcutExploration(const RouteSpace& space, const PlannedSteps& steps,
                                               int action, const bool* is_called);

}  // namespace possibility::actions
