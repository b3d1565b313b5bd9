#include "actions/verify/plan_margins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "actions/verify/verification_report.h"
#include "actions/wholebody/support_polygon.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/verify/walk_and_crawl.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The robot at rest in the first knot of walking.
Plan Standing() {
  Plan plan = testing::WalkAndCrawl().plan;
  plan.segments.resize(1);
  plan.segments[0].phases.resize(1);
  std::vector<Knot>& knots = plan.segments[0].phases[0].knots;
  knots.resize(2, knots.front());
  knots[1] = knots[0];
  knots[1].t = knots[0].t + 1;
  return plan;
}

const models::RobotModel& Robot() { return testing::WalkAndCrawl().robot; }

PlanMargins Measure(const Plan& plan, const models::Environment& environment) {
  return MeasureMargins(plan, Robot(), environment, models::GroundMap(environment));
}

PlanMargins Measure(const Plan& plan) {
  return Measure(plan, testing::WalkAndCrawl().scenario.environment);
}

std::vector<Vector3d> SolePoints(const dynamics::TreeKinematics& kinematics) {
  std::vector<Vector3d> points;
  for (const char* name : {"left_sole", "right_sole"}) {
    const models::ContactPatch& patch = Robot().contacts[Robot().ContactIndex(name)];
    for (const Vector3d& p : patch.points) points.push_back(kinematics.Position(patch.link, p));
  }
  return points;
}

/// At rest the centre of pressure is below the centre of mass.
TEST(PlanMarginsTest, ZmpAtRestIsBelowTheCentreOfMass) {
  const Plan plan = Standing();
  dynamics::TreeKinematics kinematics(Robot());
  kinematics.SetPosition(plan.segments[0].phases[0].knots[0].q);
  std::vector<Vector2d> support;
  for (const Vector3d& p : SolePoints(kinematics)) support.push_back(p.head<2>());
  const double expected =
      SupportPolygon(support).Margin(Vector2d(kinematics.CentreOfMass().head<2>()));
  EXPECT_GT(expected, 0.01);
  EXPECT_NEAR(Measure(plan).zmp.value, expected, 1e-6);
}

TEST(PlanMarginsTest, DistancesToEdgesAndObstaclesAreThoseOfTheScene) {
  const Plan plan = Standing();
  dynamics::TreeKinematics kinematics(Robot());
  kinematics.SetPosition(plan.segments[0].phases[0].knots[0].q);
  double toes = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : SolePoints(kinematics)) toes = std::max(toes, p.x());
  double front = -std::numeric_limits<double>::infinity();
  for (int link = 0; link < Robot().num_links(); ++link) {
    for (const models::PosedShape& posed : Robot().links[link].shapes) {
      front = std::max(front, posed.shape.Bounds(kinematics.X_WL()[link] * posed.X_PS).max().x());
    }
  }
  models::Environment environment = testing::WalkAndCrawl().scenario.environment;
  environment.obstacles.resize(1);
  environment.obstacles[0].shape = models::Shape::Box({4, 4, 0.1});
  environment.obstacles[0].X_WO.translation() = Vector3d(toes + 0.07 - 2, 0, -0.05);
  models::Obstacle wall;
  wall.name = "wall";
  wall.shape = models::Shape::Box({0.2, 4, 4});
  wall.X_WO.translation().x() = front + 0.03 + 0.1;
  environment.obstacles.push_back(wall);
  const PlanMargins margins = Measure(plan, environment);
  EXPECT_NEAR(margins.ground_edge.value, 0.07, 1e-5);
  EXPECT_NEAR(margins.obstacle_distance.value, 0.03, 1e-4);
  EXPECT_EQ(Measure(plan).obstacle_distance.value, PlanMargins::kFarthest);
}

TEST(PlanMarginsTest, SharesOfLimitsAreFoundWhereTheyAreGreatest) {
  Plan plan = testing::WalkAndCrawl().plan;
  const std::size_t segment = plan.segments.size() - 1;
  Phase& phase = plan.segments[segment].phases.front();
  Knot& knot = phase.knots[1];
  knot.tau[3] = -1.25 * Robot().joints[3].effort;
  knot.v[6 + 4] = 1.5 * Robot().joints[4].velocity;
  knot.forces.col(0) = Vector3d(0, 1.75 * Robot().friction * 100, 100);
  const PlanMargins margins = Measure(plan);
  EXPECT_NEAR(margins.torque.value, 1.25, 1e-12);
  EXPECT_NEAR(margins.joint_speed.value, 1.5, 1e-12);
  EXPECT_NEAR(margins.friction.value, 1.75, 1e-12);
  for (const Margin& margin : {margins.torque, margins.joint_speed, margins.friction}) {
    EXPECT_EQ(margin.segment, static_cast<int>(segment));
    EXPECT_EQ(margin.time, knot.t);
  }
}

TEST(PlanMarginsTest, APlanThatVerifiesKeepsItsLimits) {
  const PlanMargins margins = Measure(testing::WalkAndCrawl().plan);
  for (const Margin& share : {margins.torque, margins.joint_speed, margins.friction}) {
    EXPECT_GT(share.value, 0);
    EXPECT_LE(share.value, 1);
  }
  for (const Margin& length : {margins.zmp, margins.ground_edge, margins.self_distance}) {
    EXPECT_GT(length.value, 0);
  }
}

TEST(PlanMarginsTest, FlightHasNoZmp) {
  Plan plan = Standing();
  Phase& phase = plan.segments[0].phases[0];
  phase.contacts.clear();
  for (Knot& knot : phase.knots) knot.forces.resize(3, 0);
  VerificationReport report;
  report.margins = Measure(plan);
  EXPECT_EQ(report.margins->zmp.segment, -1);
  const nlohmann::json json = nlohmann::json::parse(FormatJson(report));
  EXPECT_TRUE(json["margins"]["zmp"].is_null());
  EXPECT_EQ(json["margins"]["self_distance"]["segment"], 0);
  EXPECT_EQ(FormatText(report).find("zmp"), std::string::npos);
  EXPECT_NE(FormatText(report).find("self_distance"), std::string::npos);
}

}  // namespace
}  // namespace possibility::actions
