// Shortcuts of routes, and the floods that answer "no".

#include "actions/route/route.h"

#include <gtest/gtest.h>

#include "actions/conditions/exploration_pose.h"
#include "actions/flood/necessary_flood.h"
#include "actions/flood/route_flood.h"
#include "actions/flood/sufficient_flood.h"
#include "actions/route/shortcuts.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

class RouteTest : public ::testing::Test {
 protected:
  void Load(const models::Environment& environment) {
    environment_ = environment;
    ground_ = std::make_unique<models::GroundMap>(environment_);
    world_ = {&environment_, ground_.get()};
    const auto space =
        std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_->levels(), 0.137);
    gaits_.clear();
    for (int gait = 0; gait < 2; ++gait) {
      gaits_.push_back(std::make_shared<QuasiStaticAction>(model_, gait, world_, space, 0.25));
    }
  }

  /// A random clear walk through the scene: legs that meet C_S, end to end.
  Route RandomRoute(std::mt19937* generator, int legs) const {
    std::uniform_real_distribution<double> unit(-1, 1);
    Route route;
    PlanarPose at;
    do {
      at = RandomStance(generator, 2.5);
    } while (gaits_[0]->Examine({0, at, 0}) != StanceFault::kNone);
    for (int tries = 0; static_cast<int>(route.size()) < legs && tries < 1000; ++tries) {
      RouteLeg leg;
      leg.from = at;
      leg.to = at * PlanarPose{0.4 * unit(*generator), 0.3 * unit(*generator), unit(*generator)};
      if (!gaits_[0]->CS(LegEdge(model_, leg))) continue;
      route.push_back(leg);
      at = leg.to;
    }
    return route;
  }

  const LocomotionModel& model_ = DrcHubo1Locomotion();
  models::Environment environment_;
  std::unique_ptr<models::GroundMap> ground_;
  World world_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;
};

/// The route after shortcuts until no more are found.
Route Shortened(const LocomotionModel& model,
                const std::vector<std::shared_ptr<QuasiStaticAction>>& actions,
                const Route& route) {
  const std::vector<std::shared_ptr<SearchedManoeuvre>> none;
  std::vector<graph::PathEdge> edges;
  for (const RouteLeg& leg : route) edges.push_back({EndGait(model, leg), LegEdge(model, leg)});
  double duration = ExpectedDuration(model, route);
  for (int pass = 0; pass < 20; ++pass) {
    edges = FindShortcuts({&model, &actions, &none}, edges, {}, {});
    const double shorter = ExpectedDuration(model, RouteAlong(model, none, edges));
    EXPECT_LE(shorter, duration + 1e-9);
    if (shorter > duration - 1e-6) break;
    duration = shorter;
  }
  return RouteAlong(model, none, edges);
}

TEST_F(RouteTest, ShortenedRoutesAreConnectedSufficientAndNoSlower) {
  std::mt19937 generator(4);
  for (int trial = 0; trial < 10; ++trial) {
    Load(RandomEnvironment(&generator, 8));
    const Route route = RandomRoute(&generator, 12);
    if (route.empty()) continue;
    const Route refined = Shortened(model_, gaits_, route);
    EXPECT_LE(ExpectedDuration(model_, refined), ExpectedDuration(model_, route) + 1e-9);
    EXPECT_LT((refined.front().from.position() - route.front().from.position()).norm(), 1e-9);
    EXPECT_LT((refined.back().to.position() - route.back().to.position()).norm(), 1e-9);
    EXPECT_NEAR(WrapAngle(refined.front().from.yaw - route.front().from.yaw), 0, 1e-9);
    EXPECT_NEAR(WrapAngle(refined.back().to.yaw - route.back().to.yaw), 0, 1e-9);
    for (size_t i = 0; i < refined.size(); ++i) {
      EXPECT_TRUE(gaits_[EndGait(model_, refined[i])]->CS(LegEdge(model_, refined[i])));
      if (i == 0) continue;
      EXPECT_EQ(EndGait(model_, refined[i - 1]), StartGait(model_, refined[i]));
      EXPECT_LT((refined[i - 1].to.position() - refined[i].from.position()).norm(), 1e-9);
      EXPECT_NEAR(refined[i - 1].to.yaw, refined[i].from.yaw, 1e-9);
    }
  }
}

/// Legs between two stances of one gait are a detour if the straight way is clear and quicker.
TEST_F(RouteTest, AShortenedRouteHasNoDetours) {
  std::mt19937 generator(14);
  int detours = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Load(RandomEnvironment(&generator, 8));
    const Route route = RandomRoute(&generator, 30);
    if (route.empty()) continue;
    const auto expect_none = [&](const Route& legs, bool expected) {
      for (size_t i = 0; i < legs.size(); ++i) {
        for (size_t j = i + 1; j < legs.size(); ++j) {
          RouteLeg direct = legs[i];
          direct.to = legs[j].to;
          direct.to.yaw = direct.from.yaw + WrapAngle(direct.to.yaw - direct.from.yaw);
          const Route between(legs.begin() + static_cast<std::ptrdiff_t>(i),
                              legs.begin() + static_cast<std::ptrdiff_t>(j) + 1);
          const bool is_detour =
              ExpectedDuration(model_, {direct}) < ExpectedDuration(model_, between) - 1e-6 &&
              gaits_[direct.gait]->CS(LegEdge(model_, direct));
          if (expected) {
            EXPECT_FALSE(is_detour) << trial << ": " << i << ".." << j;
          } else {
            detours += is_detour ? 1 : 0;
          }
        }
      }
    };
    expect_none(route, false);
    expect_none(Shortened(model_, gaits_, route), true);
  }
  EXPECT_GT(detours, 1000);
}

/// Down, up again at the same place, and on. Searches do build such routes.
TEST_F(RouteTest, ATransitionThatIsUndoneIsLeftOut) {
  Load(ShippedScenario("three_routes_a").environment);
  const PlanarPose a{2, 2.9, 0};
  const PlanarPose& down = model_.transitions[0].displacement;
  const auto leg = [](int gait, const PlanarPose& from, const PlanarPose& to) {
    RouteLeg straight;
    straight.gait = gait;
    straight.from = from;
    straight.to = to;
    return straight;
  };
  RouteLeg sit = leg(0, a, a * down);
  sit.transition = 0;
  RouteLeg stand = leg(0, a * down, a);
  stand.transition = 0;
  stand.backwards = true;
  ASSERT_EQ(model_.transitions[0].from, 0);
  const Route after_a_landing = {leg(1, a * PlanarPose{-0.4, 0, 0} * down, a * down), stand, sit,
                                 stand, leg(0, a, a * PlanarPose{0.8, 0, 0})};
  for (const Route& route : {Route(after_a_landing.begin() + 1, after_a_landing.end()),
                             Route(after_a_landing.begin() + 2, after_a_landing.end())}) {
    const Route shortened = Shortened(model_, gaits_, route);
    int transitions = 0;
    for (const RouteLeg& step : shortened) transitions += step.transition >= 0 ? 1 : 0;
    EXPECT_EQ(transitions, StartGait(model_, route.front()) == 0 ? 0 : 1);
  }
}

/// A closed flood is a proof, so no random clear route may end beyond it.
TEST_F(RouteTest, FloodsNeverRuleOutARouteThatExists) {
  std::mt19937 generator(8);
  int closed = 0;
  for (int trial = 0; trial < 8; ++trial) {
    Load(RandomEnvironment(&generator, 15));
    const Route route = RandomRoute(&generator, 10);
    if (route.empty()) continue;
    const GroundedStance start{0, route.front().from, 0}, goal{0, route.back().to, 0};
    EXPECT_TRUE(FloodSufficient(model_, world_, start, {goal}, {}).route_may_exist);
    EXPECT_TRUE(FloodSufficient(model_, world_, start, {goal}, {.halvings = 3}).route_may_exist);
    EXPECT_TRUE(FloodNecessary(model_, world_, start, {goal}, 0.1).route_may_exist);
    const GroundedStance outside{0, {100, 0, 0}, 0};
    closed += !FloodSufficient(model_, world_, start, {outside}, {}).route_may_exist;
  }
  EXPECT_GT(closed, 0);
}

TEST_F(RouteTest, ABarTooLowForWalkingRulesOutWalkingAloneAndIsNamed) {
  models::Scenario scenario = ShippedScenario("three_routes_b");
  Load(scenario.environment);
  const GroundedStance start{0, {scenario.start.x, scenario.start.y, 0}, 0};
  const GroundedStance goal{0, {scenario.goals[0].x, scenario.goals[0].y, 0}, 0};
  EXPECT_TRUE(FloodSufficient(model_, world_, start, {goal}, {}).route_may_exist);
  const LocomotionModel walking = DrcHubo1Walking();
  const FloodResult flood = FloodSufficient(walking, world_, start, {goal}, {});
  EXPECT_FALSE(flood.route_may_exist);
  ASSERT_FALSE(flood.barrier.closed_by.empty());
  EXPECT_NE(flood.barrier.closed_by.front().find("bar"), std::string::npos);
  EXPECT_TRUE(FloodNecessary(walking, world_, start, {goal}, 0.1).route_may_exist);
}

}  // namespace
}  // namespace possibility::actions
