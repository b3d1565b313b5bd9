#pragma once

#include "actions/route/route_motion.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions::testing {

/// A stride of walking, the transition, a stride of crawling and the transition back, as the
/// planner generates them.
inline const VerifierSubject& WalkAndCrawl() {
  static const VerifierSubject subject = [] {
    const LocomotionModel& model = DrcHubo1Locomotion();
    VerifierSubject result{{}, DrcHubo1(), ValidSubject().scenario};
    const models::Stance& start = result.scenario.start;
    const auto leg = [&](int transition, bool backwards, int gait, const PlanarPose& from,
                         const PlanarPose& displacement) {
      RouteLeg route_leg;
      route_leg.transition = transition;
      route_leg.backwards = backwards;
      route_leg.gait = gait;
      route_leg.from = from;
      route_leg.to = from * displacement;
      route_leg.z = start.z;
      return route_leg;
    };
    const PlanarPose sit = model.transitions[0].displacement;
    Route route = {leg(-1, false, 0, {start.x, start.y, start.yaw}, {0.2, 0, 0})};
    route.push_back(leg(0, false, 0, route.back().to, sit));
    route.push_back(leg(-1, false, 1, route.back().to, {0.15, 0, 0}));
    route.push_back(leg(0, true, 0, route.back().to, sit.Inverse()));
    result.plan = ValidSubject().plan;
    result.plan.segments = GenerateMotion(model, result.scenario.environment, route, 1, {});
    result.scenario.actions = {"walk", "crawl"};
    result.scenario.goals = {start};
    result.scenario.goals[0].x = route.back().to.x;
    result.scenario.goals[0].y = route.back().to.y;
    return result;
  }();
  return subject;
}

}  // namespace possibility::actions::testing
