#include "experiments/samples/feed_forward.h"

#include <gtest/gtest.h>

#include "dynamics/tree/tree_motion.h"
#include "experiments/samples/export_subject.h"
#include "experiments/samples/quantities.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class FeedForwardTest : public ::testing::Test {
 protected:
  /// What the sample's torques and forces leave of the motion: our own inverse dynamics instead of
  /// Simbody's. N, N m.
  Eigen::VectorXd Residual(const PlanSample& sample) {
    motion_.SetState(sample.knot.q, sample.knot.v, sample.knot.a);
    Eigen::VectorXd given = Eigen::VectorXd::Zero(robot_.nv());
    given.tail(robot_.num_joints()) = sample.knot.tau;
    Eigen::Index column = 0;
    for (const auto& point : actions::BearingPoints(robot_, *sample.phase)) {
      motion_.kinematics().AddPointForce(point.link, point.p_L, sample.knot.forces.col(column++),
                                         &given);
    }
    return motion_.InverseDynamics() - given;
  }

  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = testing::SampleScenario();
  dynamics::TreeMotion motion_{robot_};
};

TEST_F(FeedForwardTest, RealisesTheMotionBetweenKnots) {
  int between = 0;
  VisitSamples({plan_, robot_, scenario_}, {0.1, false}, [&](const PlanSample& sample) {
    if (sample.is_knot) return;
    ++between;
    EXPECT_LT(Residual(sample).cwiseAbs().maxCoeff(), 1e-9) << sample.knot.t;
  });
  EXPECT_GT(between, 30);
}

TEST_F(FeedForwardTest, LeavesKnotsAsThePlanHasThem) {
  PlanSample sample{1, &plan_.segments[1].phases[0], plan_.segments[1].phases[0].knots[3]};
  FeedForward(robot_).Complete(&sample);
  EXPECT_EQ(sample.knot.tau, plan_.segments[1].phases[0].knots[3].tau);
  EXPECT_EQ(sample.knot.forces, plan_.segments[1].phases[0].knots[3].forces);
}

TEST_F(FeedForwardTest, LinearForcesWouldNotRealiseTheMotion) {
  double worst = 0;
  VisitEvery(plan_, 0.1, [&](const PlanSample& sample) {
    worst = std::max(worst, Residual(sample).cwiseAbs().maxCoeff());
  });
  EXPECT_GT(worst, 1) << "the sample plan does not balance by itself";
}

}  // namespace
}  // namespace possibility::experiments
