#include "actions/conditions/manoeuvre.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/flood/route_flood.h"
#include "actions/flood/sufficient_flood.h"
#include "actions/planner/planner.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

std::string MessageOf(const models::Scenario& scenario,
                      const std::vector<ManoeuvreFactory>& manoeuvres,
                      const std::vector<std::string>& actions = {}) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.time_limit = 1000;
  request.manoeuvres = manoeuvres;
  request.actions = actions;
  try {
    PlanTraversal(DrcHubo1(), scenario, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void ExpectOneLine(const std::string& message, const std::vector<std::string>& parts) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
  }
}

TEST(ManoeuvreTest, UnknownActionNamesAreRefused) {
  const models::Scenario scenario = PitScene(true);
  const ManoeuvreFactory leap = LeapFactory(Refutes, Slides);
  ExpectOneLine(MessageOf(scenario, {}), {"pit.yaml: actions", "no action 'vault'"});
  ExpectOneLine(MessageOf(scenario, {leap}, {"walk", "valut"}),
                {"pit.yaml: actions", "no action 'valut'", "vault"});
  models::Scenario stands = scenario;
  stands.start.action = "vault";
  ExpectOneLine(MessageOf(stands, {leap}), {"start.action", "'vault' is not a gait"});
}

TEST(ManoeuvreTest, NamesThatAreTakenAreRefused) {
  models::Scenario scenario = PitScene(true);
  scenario.actions = {"walk"};
  for (const std::string name : {"walk", "crawl", "jump"}) {
    ManoeuvreFactory leap = LeapFactory(Refutes, Slides);
    leap.name = name;
    ExpectOneLine(MessageOf(scenario, {leap}, {"walk"}), {"pit.yaml: actions", "'" + name + "'"});
  }
  const ManoeuvreFactory leap = LeapFactory(Refutes, Slides);
  ExpectOneLine(MessageOf(scenario, {leap, leap}), {"pit.yaml: actions", "'vault'"});
}

TEST(ManoeuvreTest, FactoriesThatMakeNoManoeuvreOfTheirNameAreRefused) {
  models::Scenario scenario = PitScene(true);
  const auto nothing = [](const PlanningContext&) { return std::shared_ptr<Manoeuvre>(); };
  ExpectOneLine(MessageOf(scenario, {{"vault", nothing}}), {"pit.yaml", "'vault' made nothing"});
  ExpectOneLine(MessageOf(scenario, {{"vault", {}}}), {"pit.yaml", "'vault' is empty"});
  ManoeuvreFactory hop = LeapFactory(Refutes, Slides);
  hop.name = "hop";
  scenario.actions = {"walk"};
  ExpectOneLine(MessageOf(scenario, {hop}, {"walk", "hop"}), {"'hop' made one called 'vault'"});
}

TEST(ManoeuvreTest, AManoeuvreWithoutItsGaitsIsRefused) {
  models::Scenario scenario = PitScene(true);
  scenario.start.action = "crawl";
  scenario.goals = {scenario.start};
  ExpectOneLine(MessageOf(scenario, {LeapFactory(Refutes, Slides)}, {"crawl", "vault"}),
                {"'vault'", "not planned with"});
}

/// The goal is on an island around a random landing of a random launch, with no ground in between.
/// The flood must find the landing.
TEST(ManoeuvreTest, TheFloodReachesEveryDeclaredLanding) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const LandingRange range{{Eigen::Vector2d(1.6, -0.4), Eigen::Vector2d(2.2, 0.4)}, 0.35};
  for (int i = 0; i < 60; ++i) {
    const PlanarPose launch{0.2 * unit(generator), 0.2 * unit(generator), 3 * unit(generator)};
    const PlanarPose landing =
        launch * PlanarPose{1.9 + 0.3 * unit(generator), 0.4 * unit(generator),
                            range.turn * unit(generator)};
    const double rise = i % 2 == 0 ? 0 : 0.2;
    models::Environment environment;
    environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3));
    const auto add = [&](const PlanarPose& at, double z) {
      models::Obstacle island;
      island.shape = models::Shape::Box({0.6, 0.6, 0.1});
      island.X_WO = at.At(z - 0.05);
      island.is_ground = true;
      environment.obstacles.push_back(island);
    };
    add(launch, 0);
    add(landing, rise);
    const Context context(environment);
    const GroundedStance start{0, launch, 0};
    const GroundedStance goal{0, landing, rise};
    const auto flood = [&](const std::vector<FloodManoeuvre>& manoeuvres) {
      return FloodSufficient(DrcHubo1Locomotion(), (*context).world, start, {goal}, {}, {},
                             manoeuvres)
          .route_may_exist;
    };
    const auto only_at = [&](double height) {
      return [=](double r) {
        return std::abs(r - height) < 1e-6 ? std::optional(range) : std::nullopt;
      };
    };
    EXPECT_FALSE(flood({}));
    EXPECT_FALSE(flood({{0, 0, only_at(0.7)}}));
    EXPECT_TRUE(flood({{0, 0, only_at(rise)}})) << i;
  }
}

}  // namespace
}  // namespace possibility::actions
