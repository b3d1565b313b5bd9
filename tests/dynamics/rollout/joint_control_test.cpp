#include "dynamics/rollout/joint_control.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/forward/forward_dynamics.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::VectorXd;

class JointControlOfARandomTree : public ::testing::Test {
 protected:
  JointControlOfARandomTree()
      : random_(8), model_(MultibodyModel::Spatial(RandomTree(&random_, 5))), forward_(model_) {
    SetState(VectorXd::Zero(model_->nv()));
  }

  void SetState(const VectorXd& v) {
    q_ = RandomVector(&random_, model_->nq(), 1);
    q_.head<4>().normalize();
    v_ = v;
    forward_.SetState(q_, v_);
  }

  VectorXd Torques(const JointControl& control, double t, bool is_supported = true) {
    JointTorques torques(*model_, control);
    return torques.Evaluate(t, q_, v_, is_supported, forward_.dynamics());
  }

  std::vector<HeldPoint> RandomPoints(int count) {
    std::vector<HeldPoint> points;
    for (int i = 0; i < count; ++i) {
      HeldPoint held;
      held.point.link = 0;
      held.point.p_L = RandomVector(&random_, 3, 0.5);
      held.anchor = forward_.dynamics()->Position(held.point);
      points.push_back(held);
    }
    return points;
  }

  std::mt19937 random_;
  std::shared_ptr<const MultibodyModel> model_;
  ForwardDynamics forward_;
  VectorXd q_, v_;
};

TEST_F(JointControlOfARandomTree, FeedForwardAndFeedbackAddUpWithinTheLimits) {
  SetState(RandomVector(&random_, model_->nv(), 1));
  JointControl control;
  control.stiffness = VectorXd::LinSpaced(5, 10, 50);
  control.damping = VectorXd::LinSpaced(5, 1, 2);
  control.command = [](double t, JointCommand* command) {
    command->position[1] = t;
    command->velocity[2] = 2 * t;
    command->torque[3] = 3;
    command->torque[4] = 1e5;
  };
  const VectorXd torques = Torques(control, 0.5);
  VectorXd expected =
      -control.stiffness.cwiseProduct(q_.tail(5)) - control.damping.cwiseProduct(v_.tail(5));
  expected[1] += control.stiffness[1] * 0.5;
  expected[2] += control.damping[2];
  expected[3] += 3;
  expected[4] = 500;
  EXPECT_LT((torques - expected).norm(), 1e-12);
}

TEST_F(JointControlOfARandomTree, TorqueSpeedLinesLimitDrivingTorques) {
  models::RobotModel robot = RandomTree(&random_, 5);
  for (models::Joint& joint : robot.joints) joint.actuator.line = models::TorqueSpeedLine{600, 12};
  const auto driven = MultibodyModel::Spatial(robot);
  MultibodyDynamics dynamics(driven);
  VectorXd v = VectorXd::Zero(driven->nv());
  v.tail(5) << 1, 6, -6, 6, 20;
  const VectorXd q = RandomConfiguration(&random_, robot);
  dynamics.SetState(q, v);
  JointControl control;
  control.damping = VectorXd::Constant(5, 1e-9);
  control.command = [](double, JointCommand* command) {
    command->torque << 1e4, 1e4, -1e4, -1e4, 1e4;
  };
  JointTorques torques(*driven, control);
  VectorXd expected(5);
  expected << 500, 300, -300, -500, 0;
  EXPECT_EQ(torques.Evaluate(0, q, v, true, &dynamics), expected);
  EXPECT_EQ(torques.Damping(), VectorXd::Zero(5));
  EXPECT_EQ(dynamics.torque_limits(), VectorXd(expected.cwiseAbs().cwiseMin(300).array().max(0) +
                                               VectorXd::Unit(5, 0).array() * 200));
}

TEST_F(JointControlOfARandomTree, GravityCompensationKeepsJointsFromAcceleratingAtRest) {
  JointControl control;
  control.compensates_gravity = true;
  // The tree is in flight, hangs on a point or an axis, or is fixed.
  for (int count = 0; count <= 4; ++count) {
    SetState(VectorXd::Zero(model_->nv()));
    const std::vector<HeldPoint> points = RandomPoints(count);
    VectorXd forces = VectorXd::Zero(model_->nv());
    control.gravity_support.clear();
    for (const HeldPoint& held : points) control.gravity_support.push_back(held.point);
    forces.tail(5) = Torques(control, 0);
    ASSERT_LT(forces.lpNorm<Eigen::Infinity>(), 500);
    const VectorXd acceleration =
        points.empty() ? forward_.Free(forces) : forward_.Held(forces, points).acceleration;
    EXPECT_LT(acceleration.tail(5).lpNorm<Eigen::Infinity>(), 1e-8) << count << " points";
    EXPECT_EQ(Torques(control, 0, false).norm(), 0);
    if (count == 0) {
      EXPECT_LT(forces.norm(), 1e-9) << "no torque in free fall";
    }
    if (count >= 3) {
      EXPECT_LT(acceleration.norm(), 1e-8) << "a fixed base";
    }
  }
}

TEST_F(JointControlOfARandomTree, InvalidArgumentsAreRefused) {
  JointControl control;
  control.stiffness = VectorXd::Ones(4);
  EXPECT_THROW(JointTorques(*model_, control), std::invalid_argument);
  control.stiffness = VectorXd::Constant(5, -1);
  EXPECT_THROW(JointTorques(*model_, control), std::invalid_argument);
  control.stiffness = VectorXd::Constant(5, INFINITY);
  EXPECT_THROW(JointTorques(*model_, control), std::invalid_argument);
  control.stiffness.resize(0);
  control.gravity_support = {{99, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}};
  EXPECT_THROW(JointTorques(*model_, control), std::invalid_argument);
  control.gravity_support.clear();
  control.command = [](double, JointCommand* command) { command->velocity.resize(2); };
  EXPECT_THROW(Torques(control, 0), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
