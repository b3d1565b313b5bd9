#include "dynamics/tree/tree_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct RandomState {
  explicit RandomState(unsigned seed, int num_joints = 12)
      : random(seed), model(RandomTree(&random, num_joints)), kinematics(model) {
    q = RandomConfiguration(&random, model);
    v = RandomVector(&random, model.nv(), 3);
    a = RandomVector(&random, model.nv(), 10);
    link = static_cast<int>(random() % model.num_links());
    p_L = RandomVector(&random, 3, 0.5);
  }
  void Set(const VectorXd& at, const VectorXd& velocity) {
    kinematics.SetPosition(at);
    kinematics.SetVelocity(velocity);
  }
  /// The state after time t of motion with velocity v and acceleration a at t = 0, exact to t^2.
  void SetAfter(double t) { Set(Moved(q, v + t / 2 * a, t), v + t * a); }

  std::mt19937 random;
  models::RobotModel model;
  TreeKinematics kinematics;
  VectorXd q, v, a;
  int link;
  Vector3d p_L;
};

constexpr int kTrials = 50;
constexpr double kStep = 1e-5;

TEST(TreeKinematics, PosesAgreeWithAHandComputedChain) {
  models::RobotModel model;
  model.links.resize(3);
  model.joints.resize(2);
  model.joints[0].X_PJ.translation() = Vector3d(0, 0, 1);
  model.joints[0].axis = Vector3d::UnitY();
  model.joints[1].type = models::JointType::kPrismatic;
  model.joints[1].parent = 1;
  model.joints[1].X_PJ.translation() = Vector3d(0, 0, 2);
  model.joints[1].axis = Vector3d::UnitZ();
  for (models::Link& link : model.links) link.inertial.mass = 1;
  TreeKinematics kinematics(model);
  VectorXd q(9);
  // The root is turned by a quarter about z (quaternion of length 2), the joint by a quarter about
  // its y. The chain then points along the root's x, which is the world's y.
  q << std::sqrt(2.0), 0, 0, std::sqrt(2.0), 10, 20, 30, M_PI / 2, 0.5;
  kinematics.SetPosition(q);
  EXPECT_TRUE(kinematics.Position(2, Vector3d::Zero()).isApprox(Vector3d(10, 22.5, 31), 1e-14));
  EXPECT_TRUE(kinematics.Position(2, Vector3d(0, 0, 1)).isApprox(Vector3d(10, 23.5, 31), 1e-14));
  EXPECT_EQ(kinematics.SupportingJoints(2), (std::vector<int>{0, 1}));
}

TEST(TreeKinematics, VelocitiesAreDerivativesOfPoses) {
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomState s(trial);
    s.Set(Moved(s.q, s.v, kStep), s.v);
    const Vector3d after = s.kinematics.Position(s.link, s.p_L);
    const Eigen::Matrix3d R_after = s.kinematics.X_WL()[s.link].linear();
    const Vector3d com_after = s.kinematics.CentreOfMass();
    s.Set(Moved(s.q, s.v, -kStep), s.v);
    const Vector3d before = s.kinematics.Position(s.link, s.p_L);
    const Eigen::Matrix3d R_before = s.kinematics.X_WL()[s.link].linear();
    const Vector3d com_before = s.kinematics.CentreOfMass();
    s.Set(s.q, s.v);
    const Eigen::AngleAxisd turn(R_after * R_before.transpose());
    EXPECT_LT((s.kinematics.Velocity(s.link, s.p_L) - (after - before) / (2 * kStep)).norm(), 1e-6);
    EXPECT_LT(
        (s.kinematics.AngularVelocity(s.link) - turn.axis() * turn.angle() / (2 * kStep)).norm(),
        1e-6);
    EXPECT_LT((s.kinematics.CentreOfMassVelocity() - (com_after - com_before) / (2 * kStep)).norm(),
              1e-6);
  }
}

TEST(TreeKinematics, JacobiansMapVelocitiesOfEveryDirection) {
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomState s(trial);
    s.Set(s.q, s.v);
    MatrixXd J, J_com, rows(6, s.model.nv());
    s.kinematics.FrameJacobian(s.link, s.p_L, &J);
    s.kinematics.CentreOfMassJacobian(&J_com);
    s.kinematics.AngularJacobian(s.link, rows.topRows(3));
    s.kinematics.PointJacobian(s.link, s.p_L, rows.bottomRows(3));
    EXPECT_EQ(J, rows);
    for (int i = 0; i < s.model.nv(); ++i) {
      s.kinematics.SetVelocity(VectorXd::Unit(s.model.nv(), i));
      EXPECT_LT((J.col(i).head<3>() - s.kinematics.AngularVelocity(s.link)).norm(), 1e-13);
      EXPECT_LT((J.col(i).tail<3>() - s.kinematics.Velocity(s.link, s.p_L)).norm(), 1e-12);
      EXPECT_LT((J_com.col(i) - s.kinematics.CentreOfMassVelocity()).norm(), 1e-12);
    }
  }
}

TEST(TreeKinematics, BiasesAreDerivativesOfVelocityAtZeroAcceleration) {
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomState s(trial);
    s.a.setZero();
    s.SetAfter(kStep);
    const Vector3d after = s.kinematics.Velocity(s.link, s.p_L);
    const Vector3d angular_after = s.kinematics.AngularVelocity(s.link);
    const Vector3d com_after = s.kinematics.CentreOfMassVelocity();
    s.SetAfter(-kStep);
    const Vector3d before = s.kinematics.Velocity(s.link, s.p_L);
    const Vector3d angular_before = s.kinematics.AngularVelocity(s.link);
    const Vector3d com_before = s.kinematics.CentreOfMassVelocity();
    s.SetAfter(0);
    const Eigen::Matrix<double, 6, 1> bias = s.kinematics.FrameBias(s.link, s.p_L);
    const double scale = 1 + bias.norm();
    EXPECT_LT((bias.head<3>() - (angular_after - angular_before) / (2 * kStep)).norm(),
              1e-6 * scale);
    EXPECT_LT((bias.tail<3>() - (after - before) / (2 * kStep)).norm(), 1e-6 * scale);
    EXPECT_LT((s.kinematics.CentreOfMassBias() - (com_after - com_before) / (2 * kStep)).norm(),
              1e-6 * scale);
  }
}

TEST(TreeKinematics, PointForcesAreDualToVelocities) {
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomState s(trial);
    s.Set(s.q, s.v);
    const Vector3d force = RandomVector(&s.random, 3, 100);
    VectorXd generalised = s.a;
    s.kinematics.AddPointForce(s.link, s.p_L, force, &generalised);
    MatrixXd J;
    s.kinematics.FrameJacobian(s.link, s.p_L, &J);
    EXPECT_LT((generalised - s.a - J.bottomRows<3>().transpose() * force).norm(), 1e-11);
  }
}

TEST(TreeKinematics, RefusesInvalidArguments) {
  RandomState s(1, 3);
  EXPECT_THROW(s.kinematics.SetPosition(VectorXd::Zero(9)), std::invalid_argument);
  EXPECT_THROW(s.kinematics.SetPosition(VectorXd::Zero(10)), std::invalid_argument);
  s.q[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(s.kinematics.SetPosition(s.q), std::invalid_argument);
  EXPECT_THROW(s.kinematics.SetVelocity(VectorXd::Zero(10)), std::invalid_argument);
  s.model.joints[0].parent = 2;
  EXPECT_THROW(TreeKinematics{s.model}, std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
