#include "dynamics/tree/floating_motion.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "dynamics/tree/base_joints.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/richardson.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A random tree; of the larger ones a joint is locked and another is a mimic.
struct RandomSystem {
  explicit RandomSystem(std::mt19937* random, int joints) : tree(RandomTree(random, joints)) {
    if (joints > 4) {
      tree.joints[1].mimic = models::Mimic{3, -2, 0.5};
      model = MultibodyModel::OnJoints(tree, {{2, 0.7}});
    } else {
      model = MultibodyModel::OnJoints(tree);
    }
  }
  models::RobotModel tree;
  std::shared_ptr<const MultibodyModel> model;
};

TEST(FloatingMotion, VelocityAndAccelerationAreTheRatesOfTheMotion) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const RandomSystem system(&random, 1 + trial % 7);
    const int n = system.model->nv();
    const VectorXd q = RandomVector(&random, n, 1.2);
    const VectorXd v = RandomVector(&random, n, 2);
    const VectorXd a = RandomVector(&random, n, 5);
    const auto at = [&](double t) {
      return ToFloating(*system.model, q + t * v + t * t / 2 * a, v + t * a, a);
    };
    // The rates of the tree's own coordinates, mimics included.
    const FloatingMotion now = at(0);
    const VectorXd q_rate = RichardsonDerivative([&](double t) -> VectorXd { return at(t).q; });
    const Eigen::Quaterniond spin(0, now.v[0] / 2, now.v[1] / 2, now.v[2] / 2);
    const Eigen::Quaterniond turned =
        spin * Eigen::Quaterniond(now.q[0], now.q[1], now.q[2], now.q[3]);
    VectorXd expected(now.q.size());
    expected << turned.w(), turned.x(), turned.y(), turned.z(), now.v.tail(now.v.size() - 3);
    EXPECT_LT(RelativeError(q_rate, expected), 1e-8);
    const VectorXd v_rate = RichardsonDerivative([&](double t) -> VectorXd { return at(t).v; });
    EXPECT_LT(RelativeError(v_rate, now.a), 1e-8);
  }
}

TEST(FloatingMotion, PositionsComeBack) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const RandomSystem system(&random, 1 + trial % 7);
    const int n = system.model->nv();
    VectorXd q = RandomVector(&random, n, 1.2);
    q[3] *= 2.5;   // yaw: to beyond a right angle
    q[5] *= -2.5;  // pitch
    const VectorXd none = VectorXd::Zero(n);
    const VectorXd back = FromFloating(*system.model, ToFloating(*system.model, q, none, none).q);
    EXPECT_LT((back - q).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(FloatingMotion, PositionsOfAnotherSizeOrBaseAreRefused) {
  std::mt19937 random(4);
  const RandomSystem system(&random, 3);
  EXPECT_THROW(FromFloating(*system.model, VectorXd::Zero(9)), std::invalid_argument);
  EXPECT_THROW(FromFloating(*MultibodyModel::Spatial(system.tree), VectorXd::Zero(10)),
               std::invalid_argument);
}

TEST(FloatingMotion, HasTheSameForcesAndPoints) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const models::RobotModel tree = RandomTree(&random, 1 + trial % 7);
    const auto on_joints = MultibodyModel::OnJoints(tree);
    MultibodyDynamics joints(on_joints), floating(MultibodyModel::Spatial(tree));
    const int n = on_joints->nv();
    const VectorXd q = RandomVector(&random, n, 1.2);
    const VectorXd v = RandomVector(&random, n, 2);
    const VectorXd a = RandomVector(&random, n, 5);
    const FloatingMotion same = ToFloating(*on_joints, q, v, a);
    joints.SetState(q, v, a);
    floating.SetState(same.q, same.v, same.a);
    const VectorXd forces = joints.InverseDynamics();
    const VectorXd expected = floating.InverseDynamics();
    EXPECT_LT(RelativeError(forces.tail(n - 6), expected.tail(n - 6)), 1e-11);
    EXPECT_LT(RelativeError(forces.head(3), expected.segment(3, 3)), 1e-11);
    EXPECT_NEAR(forces.dot(v), expected.dot(same.v), 1e-9 * forces.norm());
    const Vector3d p_L = RandomVector(&random, 3, 0.3);
    const ContactPoint on_tree{tree.num_links() - 1 + kNumBaseJoints, p_L};
    const ContactPoint on_robot{tree.num_links() - 1, p_L};
    EXPECT_LT((joints.Position(on_tree) - floating.Position(on_robot)).norm(), 1e-13);
    EXPECT_LT((joints.Velocity(on_tree) - floating.Velocity(on_robot)).norm(), 1e-12);
    EXPECT_LT((joints.Acceleration(on_tree) - floating.Acceleration(on_robot)).norm(), 1e-11);
  }
}

TEST(FloatingMotion, RefusesAnotherBaseAndAWrongSize) {
  std::mt19937 random(3);
  const models::RobotModel tree = RandomTree(&random, 3);
  const VectorXd x = VectorXd::Zero(9);
  EXPECT_THROW(ToFloating(*MultibodyModel::Spatial(tree), x, x, x), std::invalid_argument);
  const VectorXd wrong = VectorXd::Zero(8);
  EXPECT_THROW(ToFloating(*MultibodyModel::OnJoints(tree), wrong, x, x), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
