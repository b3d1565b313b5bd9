#include "experiments/imports/knot_completion.h"

#include <gtest/gtest.h>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/tree/tree_motion.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class KnotCompletionTest : public ::testing::Test {
 protected:
  KnotCompletionTest() {
    robot_.friction = 0.7;
    robot_.joints[0].effort = 1000;
    q_ << 0.8, 0.1, -0.5, 0.3, 1, 2, 0.6, 0.2;
    q_.head<4>().normalize();
    v_ << 0.3, -0.2, 0.1, 0.5, 0.4, -0.3, 0.7;
    a_ << 1, 2, -1, 0.5, 3, 4, -2;
    for (const Eigen::Vector3d& p : robot_.contacts[0].points) sole_.push_back({1, p});
  }

  /// By our recursive inverse dynamics: what forces and torques leave of the motion.
  Eigen::VectorXd Residual(const actions::Knot& knot,
                           const std::vector<dynamics::ContactPoint>& points) {
    dynamics::TreeMotion motion(robot_);
    motion.SetState(knot.q, knot.v, knot.a);
    Eigen::VectorXd given = Eigen::VectorXd::Zero(robot_.nv());
    given.tail(robot_.num_joints()) = knot.tau;
    for (std::size_t i = 0; i < points.size(); ++i) {
      motion.kinematics().AddPointForce(points[i].link, points[i].p_L, knot.forces.col(i), &given);
    }
    return motion.InverseDynamics() - given;
  }

  actions::Knot Completed(const Eigen::VectorXd& a,
                          const std::vector<dynamics::ContactPoint>& points) {
    actions::Knot knot{0, q_, v_, a, {}, Eigen::Matrix3Xd(3, 0)};
    completion_.SetForces(points, {}, &knot);
    return knot;
  }

  models::RobotModel robot_ = testing::SampleRobot();
  KnotCompletion completion_{robot_};
  Eigen::VectorXd q_{8}, v_{7}, a_{7};
  std::vector<dynamics::ContactPoint> sole_;
};

TEST_F(KnotCompletionTest, PointsRestAtTheNearestVelocity) {
  const Eigen::VectorXd v = completion_.Resting(q_, v_, sole_);
  dynamics::TreeKinematics kinematics(robot_);
  kinematics.SetPosition(q_);
  kinematics.SetVelocity(v);
  for (const auto& point : sole_)
    EXPECT_LT(kinematics.Velocity(point.link, point.p_L).norm(), 1e-9);
  // The change is orthogonal to every motion that keeps the sole: turning the hip alone.
  Eigen::VectorXd turning = Eigen::VectorXd::Zero(7);
  turning[6] = 1;
  turning = completion_.Resting(q_, turning, sole_);
  EXPECT_GT(turning.norm(), 0.1);
  EXPECT_NEAR((v - v_).dot(turning), 0, 1e-9);
  EXPECT_EQ(completion_.Resting(q_, v_, {}), v_);
}

TEST_F(KnotCompletionTest, InFlightTheRobotFalls) {
  const Eigen::VectorXd a = completion_.Feasible(q_, v_, a_, {});
  const actions::Knot knot = Completed(a, {});
  EXPECT_LT(Residual(knot, {}).cwiseAbs().maxCoeff(), 1e-9);
  // The same acceleration as forward dynamics under these torques.
  dynamics::ForwardDynamics forward(dynamics::MultibodyModel::Spatial(robot_));
  forward.SetState(q_, v_);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(7);
  forces.tail(1) = knot.tau;
  EXPECT_LT((forward.Free(forces) - a).norm(), 1e-8);
}

TEST_F(KnotCompletionTest, PointsDoNotAccelerateAndTheRootIsBalanced) {
  const std::vector<dynamics::ContactPoint> edge = {sole_[0], sole_[1]};
  v_ = completion_.Resting(q_, v_, edge);
  const Eigen::VectorXd a = completion_.Feasible(q_, v_, a_, edge);
  dynamics::MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(robot_));
  dynamics.SetState(q_, v_, a);
  for (const auto& point : edge) EXPECT_LT(dynamics.Acceleration(point).norm(), 1e-8);
  EXPECT_LT(Residual(Completed(a, edge), edge).cwiseAbs().maxCoeff(), 1e-7);
}

TEST_F(KnotCompletionTest, ForcesStayInTheirConesIfTheyCan) {
  q_ << 1, 0, 0, 0, 0, 0, 0.5, 0;
  v_.setZero();
  const actions::Knot knot = Completed(Eigen::VectorXd::Zero(7), sole_);
  EXPECT_LT(Residual(knot, sole_).cwiseAbs().maxCoeff(), 1e-9);
  for (const Eigen::Vector3d force : knot.forces.colwise()) {
    EXPECT_GT(force.z(), 0.9 * 2 * dynamics::kGravity / 4);
    EXPECT_LT(force.head<2>().norm(), 1e-6);
  }
}

TEST_F(KnotCompletionTest, ForcesBalanceTheRootEvenWhereTheyMustPull) {
  q_ << 1, 0, 0, 0, 0, 0, 0.5, 0;
  v_.setZero();
  a_.setZero();
  a_[5] = -20;  // faster than it falls
  const actions::Knot knot = Completed(a_, sole_);
  EXPECT_LT(Residual(knot, sole_).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(knot.forces.row(2).sum(), 0);
}

TEST_F(KnotCompletionTest, LandsLikeForwardDynamics) {
  q_ << 1, 0, 0, 0, 0, 0, 0.5, 0;
  v_ << 0, 0.1, 0, 0, 0, -1, 0.2;
  const KnotCompletion::Landing landing = completion_.Land(q_, v_, sole_);
  dynamics::ForwardDynamics forward(dynamics::MultibodyModel::Spatial(robot_));
  forward.SetState(q_, v_);
  EXPECT_LT((forward.Hit(sole_).velocity - landing.velocity).norm(), 1e-9);
  EXPECT_NEAR(landing.impulses.row(2).sum(), 2 * 1, 1e-6) << "the momentum of both links";
}

}  // namespace
}  // namespace possibility::experiments
