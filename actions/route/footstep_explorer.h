#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/route/route_space.h"
#include "graph/search/explorer.h"

namespace possibility::actions {

/// Proposes routes of one gait through places where its C_S says no. It searches footsteps from the
/// start to a goal. Where they keep to C_S for long enough, the route walks; the rest are edges of
/// PlannedSteps, for which jobs plan contacts. If a job refutes an edge, the next proposal is to
/// plan the steps of the whole way.
class FootstepExplorer : public graph::Explorer {
 public:
  /// `steps`: the manoeuvre of that gait; `action`: its number among the search's actions. Takes
  /// part once `*is_called`; sets `*gave_up` when it has nothing to propose any more. References,
  /// and what `space` points to, must outlive the search. `goals`: stances of the gait.
  FootstepExplorer(const RouteSpace& space, const PlannedSteps& steps, int action,
                   const GroundedStance& start, const std::vector<GroundedStance>& goals,
                   const bool* is_called, bool* gave_up, const graph::ExplorerContext& context);

  std::string name() const override { return "footsteps"; }
  bool TakesPart(graph::SearchStage stage) const override {
    return *is_called_ && stage == graph::SearchStage::kFirstRoute;
  }
  graph::Findings Explore() override;
  double work_of_turn() const override { return kWorkOfTurn; }
  bool OnRefuted() override;

 private:
  static constexpr double kWorkOfTurn = 10e-3;  ///< s

  /// A stance on the way, and the step that leads to it.
  struct Halt {
    GroundedStance stance;
    int step = -1;    ///< index; -1: the start
    double time = 0;  ///< s, of the steps up to here
  };

  /// Whether the search, cut short without an answer, gets more states.
  bool MayGoOn();
  const QuasiStaticAction& gait() const { return *(*space_.gaits)[start_.gait]; }
  std::vector<Halt> Halts() const;
  std::vector<graph::PathEdge> Route() const;
  std::vector<graph::PathEdge> WholeWay() const;
  /// From rest at one halt to rest at another. Empty if feet cannot be put down there.
  std::vector<Footstep> StepsBetween(const Halt& from, const Halt& to) const;
  graph::PathEdge EdgeBetween(int action, const GroundedStance& from,
                              const GroundedStance& to) const;

  RouteSpace space_;
  const PlannedSteps& steps_;
  int action_;
  GroundedStance start_;
  std::vector<GroundedStance> goals_;
  const bool* is_called_;
  bool* gave_up_;
  const Deadline* deadline_;
  std::int64_t* states_;  ///< counter
  std::optional<FootstepSearch> search_;
  int proposals_ = 0;
};

/// Makes a FootstepExplorer.
graph::ExplorerFactory FootstepExploration(const RouteSpace& space, const PlannedSteps& steps,
                                           int action, const GroundedStance& start,
                                           const std::vector<GroundedStance>& goals,
                                           const bool* is_called, bool* gave_up);

}  // namespace possibility::actions
