#pragma once

#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/plan/plan.h"
#include "graph/find_path.h"

namespace possibility::actions {

/// One leg of a route, all of it confirmed: straight on with one gait, a transition, or a
/// manoeuvre. Headings continue from leg to leg without wrapping.
struct RouteLeg {
  int gait = 0;                    ///< of an extension
  int transition = -1;             ///< index into the model's transitions, or -1 for an extension
  bool backwards = false;          ///< the transition runs from its second gait to its first
  Manoeuvre* manoeuvre = nullptr;  ///< if the leg is one
  PlanarPose from;                 ///< stance of the gait that the leg starts in
  PlanarPose to;                   ///< stance of the gait that the leg ends in
  double z = 0;                    ///< m, height of the ground that the leg starts on
  double z_to = 0;  ///< m, of the ground that it ends on: another one only after a manoeuvre
};

using Route = std::vector<RouteLeg>;

/// The gait that a leg starts in, and the one it ends in.
int StartGait(const LocomotionModel& model, const RouteLeg& leg);
int EndGait(const LocomotionModel& model, const RouteLeg& leg);

/// "walk", "walk->crawl", "jump", ...
std::string LegName(const LocomotionModel& model, const RouteLeg& leg);

/// The same with places, seen from above: "walk from (1.00, 2.00) to (3.00, 2.00)".
std::string LegWords(const LocomotionModel& model, const RouteLeg& leg);

/// The edge of E that the leg executes.
graph::PointPair LegEdge(const LocomotionModel& model, const RouteLeg& leg);

/// The route along a confirmed path. `path`: edges between nominal stances, end to end; their
/// actions are the model's gaits in order, then `manoeuvres`, which must outlive the route.
/// @throws std::logic_error if the path leaves the nominal stances.
Route RouteAlong(const LocomotionModel& model,
                 const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                 const std::vector<graph::PathEdge>& path);

/// Expected time to execute, s.
double ExpectedDuration(const LocomotionModel& model, const Route& route);

}  // namespace possibility::actions
