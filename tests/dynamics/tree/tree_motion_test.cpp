#include "dynamics/tree/tree_motion.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/dynamics/newton_euler.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct RandomMotion {
  explicit RandomMotion(unsigned seed)
      : random(seed), model(RandomTree(&random, 12)), kinematics(model), motion(model) {
    q = RandomConfiguration(&random, model);
    v = RandomVector(&random, model.nv(), 3);
    a = RandomVector(&random, model.nv(), 10);
  }
  /// The state after time t of motion with velocity v and acceleration a at t = 0, exact to t^2.
  void SetAfter(double t) {
    kinematics.SetPosition(Moved(q, v + t / 2 * a, t));
    kinematics.SetVelocity(v + t * a);
  }
  /// At t = 0.
  VectorXd InverseDynamics(const VectorXd& acceleration) {
    motion.SetState(q, v, acceleration);
    return motion.InverseDynamics();
  }

  std::mt19937 random;
  models::RobotModel model;
  TreeKinematics kinematics;
  TreeMotion motion;
  VectorXd q, v, a;
};

constexpr int kStates = 50;
constexpr double kTimeStep = 1e-5;

TEST(TreeMotion, InverseDynamicsAgreeWithNewtonAndEulerLinkByLink) {
  for (int trial = 0; trial < kStates; ++trial) {
    RandomMotion s(trial);
    s.SetAfter(0);
    const VectorXd expected = NewtonEuler(s.kinematics, s.a);
    EXPECT_LT((s.InverseDynamics(s.a) - expected).norm(), 1e-12 * expected.norm());
  }
}

/// Mechanical energy from link velocities alone.
double Energy(const TreeKinematics& kinematics) {
  double energy = 0;
  for (int i = 0; i < kinematics.model().num_links(); ++i) {
    const models::Inertial& inertial = kinematics.model().links[i].inertial;
    const Vector3d v = kinematics.Velocity(i, inertial.p_LC);
    const Vector3d w = kinematics.X_WL()[i].linear().transpose() * kinematics.AngularVelocity(i);
    energy += inertial.mass * v.squaredNorm() / 2 + w.dot(inertial.I_LC * w) / 2 +
              inertial.mass * kGravity * kinematics.Position(i, inertial.p_LC).z();
  }
  return energy;
}

TEST(TreeMotion, PowerOfInverseDynamicsIsTheRateOfEnergy) {
  for (int trial = 0; trial < kStates; ++trial) {
    RandomMotion s(trial);
    s.SetAfter(kTimeStep);
    const double after = Energy(s.kinematics);
    s.SetAfter(-kTimeStep);
    const double before = Energy(s.kinematics);
    s.SetAfter(0);
    const double power = s.InverseDynamics(s.a).dot(s.v);
    EXPECT_NEAR(power, (after - before) / (2 * kTimeStep), 1e-6 * (1 + std::abs(power)) + 1e-3);
  }
}

/// Angular momentum about a point fixed in the world.
Vector3d AngularMomentum(const TreeKinematics& kinematics, const Vector3d& about) {
  Vector3d momentum = Vector3d::Zero();
  for (int i = 0; i < kinematics.model().num_links(); ++i) {
    const models::Inertial& inertial = kinematics.model().links[i].inertial;
    const Eigen::Matrix3d R = kinematics.X_WL()[i].linear();
    momentum += R * inertial.I_LC * R.transpose() * kinematics.AngularVelocity(i) +
                (kinematics.Position(i, inertial.p_LC) - about)
                    .cross(inertial.mass * kinematics.Velocity(i, inertial.p_LC));
  }
  return momentum;
}

TEST(TreeMotion, BaseRowsObeyNewtonAndEuler) {
  for (int trial = 0; trial < kStates; ++trial) {
    RandomMotion s(trial);
    s.SetAfter(kTimeStep);
    const Vector3d momentum_after = AngularMomentum(s.kinematics, s.q.segment<3>(4));
    s.SetAfter(-kTimeStep);
    const Vector3d momentum_before = AngularMomentum(s.kinematics, s.q.segment<3>(4));
    s.SetAfter(0);
    const VectorXd forces = s.InverseDynamics(s.a);
    MatrixXd J_com;
    s.kinematics.CentreOfMassJacobian(&J_com);
    const Vector3d weight(0, 0, -kGravity * s.model.TotalMass());
    const Vector3d expected =
        s.model.TotalMass() * (J_com * s.a + s.kinematics.CentreOfMassBias()) - weight;
    EXPECT_LT((forces.segment<3>(3) - expected).norm(), 1e-12 * expected.norm());
    const Vector3d moment = (momentum_after - momentum_before) / (2 * kTimeStep) -
                            (s.kinematics.CentreOfMass() - s.q.segment<3>(4)).cross(weight);
    EXPECT_LT((forces.head<3>() - moment).norm(), 1e-6 * (moment.norm() + expected.norm()));
  }
}

TEST(TreeMotion, MassMatrixIsSymmetricAndPositive) {
  for (int trial = 0; trial < 10; ++trial) {
    RandomMotion s(trial);
    const int n = s.model.nv();
    const VectorXd bias = s.InverseDynamics(VectorXd::Zero(n));
    MatrixXd M(n, n);
    for (int i = 0; i < n; ++i) {
      M.col(i) = s.InverseDynamics(VectorXd::Unit(n, i)) - bias;
    }
    EXPECT_LT((M - M.transpose()).norm(), 1e-11 * (M.norm() + bias.norm()));
    EXPECT_GT(M.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
  }
}

TEST(TreeMotion, RefusesInvalidArguments) {
  RandomMotion s(1);
  EXPECT_THROW(s.InverseDynamics(VectorXd::Zero(8)), std::invalid_argument);
  s.q.resize(9);
  EXPECT_THROW(s.InverseDynamics(s.a), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
