#include "actions/route/route.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

/// The stance of any gait of the model whose root pose is X_WR.
std::optional<GroundedStance> AnyStance(const LocomotionModel& model,
                                        const Eigen::Isometry3d& X_WR) {
  for (size_t gait = 0; gait < model.gaits.size(); ++gait) {
    if (std::optional<GroundedStance> stance = AsStance(model, static_cast<int>(gait), X_WR)) {
      return stance;
    }
  }
  return std::nullopt;
}

RouteLeg TransitionLeg(const LocomotionModel& model, const GroundedStance& from,
                       const GroundedStance& to) {
  for (size_t i = 0; i < model.transitions.size(); ++i) {
    const LocomotionModel::TransitionEntry& transition = model.transitions[i];
    const bool forwards = transition.from == from.gait && transition.to == to.gait;
    const bool backwards = transition.from == to.gait && transition.to == from.gait;
    if (!forwards && !backwards) continue;
    RouteLeg leg;
    leg.transition = static_cast<int>(i);
    leg.backwards = backwards;
    leg.from = from.pose;
    leg.to = to.pose;
    leg.z = leg.z_to = from.z;
    return leg;
  }
  throw std::logic_error("a path changes gait without a transition");
}

}  // namespace

int StartGait(const LocomotionModel& model, const RouteLeg& leg) {
  if (leg.manoeuvre != nullptr) return leg.manoeuvre->from();
  if (leg.transition < 0) return leg.gait;
  const LocomotionModel::TransitionEntry& transition = model.transitions[leg.transition];
  return leg.backwards ? transition.to : transition.from;
}

int EndGait(const LocomotionModel& model, const RouteLeg& leg) {
  if (leg.manoeuvre != nullptr) return leg.manoeuvre->to();
  if (leg.transition < 0) return leg.gait;
  const LocomotionModel::TransitionEntry& transition = model.transitions[leg.transition];
  return leg.backwards ? transition.from : transition.to;
}

std::string LegName(const LocomotionModel& model, const RouteLeg& leg) {
  if (leg.manoeuvre != nullptr) return leg.manoeuvre->plan_action();
  const std::string& start = model.gaits[StartGait(model, leg)]->stance.gait->name;
  if (leg.transition < 0) return start;
  return start + "->" + model.gaits[EndGait(model, leg)]->stance.gait->name;
}

std::string LegWords(const LocomotionModel& model, const RouteLeg& leg) {
  return fmt::format("{} from ({:.2f}, {:.2f}) to ({:.2f}, {:.2f})", LegName(model, leg),
                     leg.from.x, leg.from.y, leg.to.x, leg.to.y);
}

graph::Edge LegEdge(const LocomotionModel& model, const RouteLeg& leg) {
  return {ToPoint(model.gaits[StartGait(model, leg)]->stance.RootPose(leg.from, leg.z)),
          ToPoint(model.gaits[EndGait(model, leg)]->stance.RootPose(leg.to, leg.z_to))};
}

Route RouteAlong(const LocomotionModel& model,
                 const std::vector<std::shared_ptr<SearchedManoeuvre>>& manoeuvres,
                 const std::vector<graph::PathEdge>& path) {
  Route route;
  for (const graph::PathEdge& edge : path) {
    const int index = edge.action - static_cast<int>(model.gaits.size());
    SearchedManoeuvre* manoeuvre =
        index < 0 ? nullptr : manoeuvres[static_cast<size_t>(index)].get();
    std::optional<GroundedStance> from =
        AsStance(model, manoeuvre ? manoeuvre->from() : edge.action, ToPose(edge.points.from));
    std::optional<GroundedStance> to =
        AsStance(model, manoeuvre ? manoeuvre->to() : edge.action, ToPose(edge.points.to));
    if (!manoeuvre && !from) from = AnyStance(model, ToPose(edge.points.from));
    if (!manoeuvre && !to) to = AnyStance(model, ToPose(edge.points.to));
    if (!from || !to) throw std::logic_error("a path leaves the nominal stances");
    RouteLeg leg;
    if (manoeuvre || from->gait == to->gait) {
      leg.gait = from->gait;
      leg.manoeuvre = manoeuvre;
      leg.from = from->pose;
      leg.to = to->pose;
      leg.z = from->z;
      leg.z_to = to->z;
    } else {
      leg = TransitionLeg(model, *from, *to);
    }
    if (!route.empty()) leg.from.yaw = route.back().to.yaw;
    leg.to.yaw = leg.from.yaw + WrapAngle(leg.to.yaw - leg.from.yaw);
    route.push_back(leg);
  }
  return route;
}

double ExpectedDuration(const LocomotionModel& model, const Route& route) {
  double duration = 0;
  for (const RouteLeg& leg : route) {
    if (leg.manoeuvre != nullptr) {
      duration += leg.manoeuvre->ExpectedDuration(LegEdge(model, leg));
    } else if (leg.transition >= 0) {
      duration += model.transitions[leg.transition].ExpectedDuration();
    } else {
      const LocomotionModel::GaitEntry& gait = *model.gaits[leg.gait];
      duration += gait.motion->WayDuration(gait.stance.gait->parameters, leg.from, leg.to);
    }
  }
  return duration;
}

}  // namespace possibility::actions
