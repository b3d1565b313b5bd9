#include "actions/rollout/rollout_gains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "actions/rollout/rollout_check.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/shipped_robots.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

double TippingOf(const models::RobotModel& robot) {
  return robot.TotalMass() * dynamics::kGravity * robot.gaits.front().posture.root_height;
}

bool IsLegJoint(const models::RobotModel& robot, int joint) {
  const std::vector<int> legs = robot.LegJoints();
  return std::find(legs.begin(), legs.end(), joint) != legs.end();
}

TEST(RolloutGainsTest, StrongJointsAreAsStiffAsTheirEffortSays) {
  const models::RobotModel& robot = DrcHubo1();
  const RolloutGains gains;
  const VectorXd stiffness = JointStiffness(robot, gains);
  for (int j = 0; j < robot.num_joints(); ++j) {
    EXPECT_DOUBLE_EQ(stiffness[j], robot.joints[j].effort / gains.full_effort_error)
        << robot.joints[j].name;
  }
}

TEST(RolloutGainsTest, StiffnessThatIsGivenIsUsedIfItFitsTheRobot) {
  RolloutGains gains;
  gains.stiffness = Eigen::VectorXd::LinSpaced(DrcHubo1().num_joints(), 1, 2);
  EXPECT_EQ(JointStiffness(DrcHubo1(), gains), gains.stiffness);
  gains.stiffness.conservativeResize(3);
  EXPECT_THROW(JointStiffness(DrcHubo1(), gains), std::invalid_argument);
}

TEST(RolloutGainsTest, WeakJointsOfLegsHoldUpTheRobot) {
  const models::RobotModel& robot = RobotNamed("h1_2").robot();
  const RolloutGains gains;
  const VectorXd stiffness = JointStiffness(robot, gains);
  int raised = 0;
  for (int j = 0; j < robot.num_joints(); ++j) {
    const double by_effort = robot.joints[j].effort / gains.full_effort_error;
    const bool is_weak = IsLegJoint(robot, j) && by_effort < 8 * TippingOf(robot);
    EXPECT_DOUBLE_EQ(stiffness[j], is_weak ? 8 * TippingOf(robot) : by_effort);
    raised += is_weak;
  }
  EXPECT_EQ(raised, 4) << "both joints of both ankles";
}

TEST(RolloutGainsTest, JointsWithoutALimitHaveNone) {
  models::RobotModel robot = DrcHubo1();
  const int knee = robot.LegJoints()[3];
  robot.joints[knee].effort = std::numeric_limits<double>::infinity();
  EXPECT_EQ(JointStiffness(robot, {})[knee], 0);
}

/// Drift of the root on a winding way of 17 s, m.
double DriftOnAWindingWay(const ShippedRobot& robot, const RolloutGains& gains) {
  const PlanarPose strides[] = {{0.12, 0, 0}, {0.08, 0.03, 0.1}, {0, 0, -0.15}, {0.05, -0.04, 0}};
  std::vector<PlanarPose> way = {{0, 0, 0}};
  for (int i = 0; i < 40; ++i) way.push_back(way.back() * strides[i / 3 % 4]);
  Segment segment;
  segment.action = "walk";
  segment.phases = robot.model().gaits[0]->motion->Flow(StraightLines(way), {}, 0.1, {});
  models::Environment environment;
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({30, 30, 0.5});
  floor.X_WO = PlanarPose().At(-0.25);
  floor.is_ground = true;
  environment.obstacles.push_back(floor);
  RolloutCheckSettings settings;
  settings.gains = gains;
  const RolloutDrift drift = RollOutSegment(
      segment, robot.robot(), models::GroundMap(environment, robot.robot().friction), settings);
  EXPECT_EQ(drift.failure, "");
  EXPECT_GT(drift.end, 15);
  return drift.worst_position;
}

/// Without it, H1-2's ankles sway at the rate of its steps, and the sway grows.
TEST(RolloutGainsTest, WeakAnklesFollowAWindingWayForTheirStandingStiffness) {
  RolloutGains gains;
  const ShippedRobot& robot = RobotNamed("h1_2");
  const double drift = DriftOnAWindingWay(robot, gains);
  EXPECT_LT(drift, 0.005);
  gains.standing_stiffness = 0;
  EXPECT_GT(DriftOnAWindingWay(robot, gains), 5 * drift);
}

}  // namespace
}  // namespace possibility::actions
