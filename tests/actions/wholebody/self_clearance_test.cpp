#include "actions/wholebody/self_clearance.h"

#include <gtest/gtest.h>

#include "dynamics/tree/tree_kinematics.h"
#include "models/world/collision.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// Crawling with the left hand folded back by an angle, rad: the hand nears the elbow.
Eigen::VectorXd FoldedHand(double angle) {
  const models::RobotModel& robot = DrcHubo1();
  Eigen::VectorXd q = robot.Configuration(robot.GaitNamed("crawl").posture);
  q[7 + robot.JointIndex("LWP")] = -angle;
  return q;
}

double LeastDistance(const Eigen::VectorXd& q) {
  const models::CollisionChecker checker(DrcHubo1(), models::Environment());
  dynamics::TreeKinematics kinematics(DrcHubo1());
  kinematics.SetPosition(q);
  double least = 1;
  for (const models::Proximity& pair : checker.SelfProximities(kinematics.X_WL(), 0.02)) {
    least = std::min(least, pair.distance);
  }
  return least;
}

// Distances to the elbow fall as the hand folds: 13 mm in the posture, 3 mm at the last angle.
constexpr double kOpen = 2.68;
constexpr double kClosed = 2.94;

TEST(SelfClearance, LinksCloserThanTheClearanceAreFaults) {
  const SelfClearance clearance(DrcHubo1(), {});
  for (double angle = kOpen; angle < kClosed; angle += 0.001) {
    const Eigen::VectorXd q = FoldedHand(angle);
    const auto faults = clearance.Faults(q, kSelfClearance);
    EXPECT_EQ(faults.empty(), LeastDistance(q) >= kSelfClearance) << angle;
    for (const SelfClearance::Fault& fault : faults) EXPECT_EQ(fault.required, kSelfClearance);
  }
}

TEST(SelfClearance, LinksMayComeATenthCloserThanAtRest) {
  const Eigen::VectorXd rest = FoldedHand(2.76);
  const double distance = LeastDistance(rest);
  ASSERT_LT(distance, 0.008);
  const SelfClearance clearance(DrcHubo1(), {FoldedHand(kOpen), rest});
  int faulty = 0;
  for (double angle = kOpen; angle < kClosed; angle += 0.001) {
    const Eigen::VectorXd q = FoldedHand(angle);
    const auto faults = clearance.Faults(q, kSelfClearance);
    EXPECT_EQ(faults.empty(), LeastDistance(q) >= 0.9 * distance) << angle;
    if (faults.empty()) continue;
    ++faulty;
    EXPECT_NEAR(faults[0].required, 0.9 * distance, 1e-12);
    EXPECT_EQ(DrcHubo1().links[faults[0].pair.link].name, "Body_LEP");
    EXPECT_EQ(DrcHubo1().links[faults[0].pair.other].name, "Body_LWR");
  }
  EXPECT_GT(faulty, 0);
}

}  // namespace
}  // namespace possibility::actions
