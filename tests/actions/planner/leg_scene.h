#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/route/route.h"
#include "actions/route/route_motion.h"
#include "actions/verify/verifier.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// A world with the gaits of a robot in it, and the verifier's verdict on legs and routes.
class LegScene {
 public:
  LegScene(const LocomotionModel& model, models::Environment environment)
      : model_(model),
        environment_(std::move(environment)),
        ground_(environment_),
        world_{&environment_, &ground_} {
    const auto space =
        std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137);
    for (size_t gait = 0; gait < model_.gaits.size(); ++gait) {
      gaits_.push_back(
          std::make_shared<QuasiStaticAction>(model_, static_cast<int>(gait), world_, space, 0.25));
    }
  }
  LegScene(const LegScene&) = delete;
  LegScene& operator=(const LegScene&) = delete;

  const models::Environment& environment() const { return environment_; }
  const World& world() const { return world_; }
  const QuasiStaticAction& action(int gait) const { return *gaits_[gait]; }

  /// The verifier's report on the leg as a whole plan.
  VerificationReport VerifyLeg(const RouteLeg& leg) const { return VerifyRoute({leg}); }

  /// The verifier's report on the route as a whole plan.
  VerificationReport VerifyRoute(const Route& route) const {
    Plan plan;
    plan.robot_hash = model_.robot->content_hash;
    for (const models::Joint& joint : model_.robot->joints) plan.joints.push_back(joint.name);
    plan.segments = GenerateMotion(model_, environment_, route, 1, {});
    models::Scenario scenario;
    scenario.environment = environment_;
    const RouteLeg& first = route.front();
    const RouteLeg& last = route.back();
    scenario.start = StanceOf(StartGait(model_, first), first.from, first.z);
    scenario.goals = {StanceOf(EndGait(model_, last), last.to, last.z)};
    return Verify(plan, *model_.robot, scenario);
  }

 private:
  models::Stance StanceOf(int gait, const PlanarPose& pose, double z) const {
    return {model_.gaits[gait]->stance.gait->name, pose.x, pose.y, z, pose.yaw};
  }

  const LocomotionModel& model_;
  models::Environment environment_;
  models::GroundMap ground_;
  World world_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;
};

}  // namespace possibility::actions
