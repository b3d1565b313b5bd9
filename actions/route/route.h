#pragma once

#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/conditions/searched_manoeuvre.h"
#include "actions/plan/plan.h"
#include "graph/search/find_path.h"

namespace possibility::actions {

/// One confirmed leg of a route: a straight way in one gait, a transition, or a manoeuvre. Headings
/// continue from leg to leg without wrapping.
struct RouteLeg {
  int gait = 0;            ///< of an extension
  int transition = -1;     ///< index into the model's transitions, or -1 for an extension
  bool backwards = false;  ///< the transition runs from its second gait to its first
  SearchedManoeuvre* manoeuvre = nullptr;  ///< null unless the leg is one
  PlanarPose from;                         ///< stance of the leg's first gait
  PlanarPose to;                           ///< stance of the leg's last gait
  double z = 0;                            ///< m, height of the ground at the start
  double z_to = 0;  ///< m, height of the ground at the end: differs only for manoeuvres
};

using Route = std::vector<RouteLeg>;

/// First and last gait of a leg.
int StartGait(const LocomotionModel& model, const RouteLeg& leg);
int EndGait(const LocomotionModel& model, const RouteLeg& leg);

/// "walk", "walk->crawl", "jump", ...
std::string LegName(const LocomotionModel& model, const RouteLeg& leg);

/// The name with horizontal positions: "walk from (1.00, 2.00) to (3.00, 2.00)".
std::string LegWords(const LocomotionModel& model, const RouteLeg& leg);

/// The edge of E that the leg executes.
graph::Edge LegEdge(const LocomotionModel& model, const RouteLeg& leg);

/// The route along a confirmed path. `path`: edges between nominal stances, end to end; their
/// actions are the model's gaits in order, then `manoeuvres`, which must outlive the route.
/// @throws std::logic_error if the path leaves the nominal stances.
Route RouteAlong(const LocomotionModel& model,
                 const std::vector<std::shared_ptr<SearchedManoeuvre>>& manoeuvres,
                 const std::vector<graph::PathEdge>& path);

/// Expected time to execute, s.
double ExpectedDuration(const LocomotionModel& model, const Route& route);

}  // namespace possibility::actions
