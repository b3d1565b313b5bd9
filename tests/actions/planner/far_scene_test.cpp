// The same scene at other places in the world.

#include <gtest/gtest.h>

#include <random>

#include "actions/plan/plan.h"
#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "actions/route/route_motion.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

/// The shipped scenario `name`, moved by this displacement.
models::Scenario MovedScenario(const std::string& name, const Vector3d& by) {
  models::Scenario scenario = ShippedScenario(name);
  models::Environment& environment = scenario.environment;
  environment.bounds.translate(Eigen::Vector2d(by.head<2>()));
  for (models::Obstacle& obstacle : environment.obstacles) obstacle.X_WO.translation() += by;
  const auto move = [&](models::Stance* stance) {
    stance->x += by.x();
    stance->y += by.y();
    stance->z += by.z();
  };
  move(&scenario.start);
  for (models::Stance& goal : scenario.goals) move(&goal);
  return scenario;
}

TEST(FarSceneTest, AGaitsMotionIsTheSameAnywhere) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 6; ++trial) {
    RouteLeg leg;
    leg.gait = trial % 2;
    leg.from = {unit(generator), unit(generator), 3 * unit(generator)};
    leg.to = leg.from * PlanarPose{0.5, 0.2 * unit(generator), unit(generator)};
    const std::vector<Phase> near = GenerateLeg(DrcHubo1Locomotion(), leg);
    const Vector3d by(1e5 * unit(generator), 1e5 * unit(generator), 1e3 * unit(generator));
    for (PlanarPose* pose : {&leg.from, &leg.to}) {
      pose->x += by.x();
      pose->y += by.y();
    }
    leg.z = leg.z_to = by.z();
    const std::vector<Phase> far = GenerateLeg(DrcHubo1Locomotion(), leg);
    ASSERT_EQ(far.size(), near.size());
    for (size_t phase = 0; phase < far.size(); ++phase) {
      ASSERT_EQ(far[phase].knots.size(), near[phase].knots.size());
      for (size_t i = 0; i < far[phase].knots.size(); ++i) {
        Knot knot = far[phase].knots[i];
        knot.q.segment<3>(4) -= by;
        EXPECT_LT((knot.q - near[phase].knots[i].q).lpNorm<Eigen::Infinity>(), 1e-9);
        EXPECT_LT((knot.v - near[phase].knots[i].v).lpNorm<Eigen::Infinity>(), 1e-8);
      }
    }
  }
}

/// Walking, crawling and a jump, simulation included. The plan read from its file verifies as well.
TEST(FarSceneTest, AHallwayFarAwayIsPlannedAndItsFileVerifies) {
  const models::Scenario scenario = MovedScenario("hallway", {10000, -7000, 300});
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.time_limit = 1000;
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  const std::string folder = ::testing::TempDir() + "/far_scene";
  std::filesystem::create_directories(folder);
  WritePlan(result.plan, folder + "/plan.json");
  const VerificationReport report = Verify(ReadPlan(folder), DrcHubo1(), scenario, {});
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

}  // namespace
}  // namespace possibility::actions
