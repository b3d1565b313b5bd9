#include "models/robot/rotation_vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace possibility::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

class RotationVectorTest : public ::testing::Test {
 protected:
  Vector3d Direction() {
    std::normal_distribution<double> normal;
    return Vector3d(normal(random_), normal(random_), normal(random_)).normalized();
  }

  std::mt19937 random_{1};
};

TEST_F(RotationVectorTest, OfAnExponentialIsItsArgumentUpToHalfATurn) {
  for (const double angle : {0.0, 1e-200, 1e-12, 1e-5, 0.3, 2.0, std::numbers::pi - 1e-9}) {
    const Vector3d phi = angle * Direction();
    const Eigen::Quaterniond rotation(Exponential(phi));
    EXPECT_LE((RotationVector(rotation) - phi).norm(), 1e-15 + 1e-14 * angle) << angle;
    EXPECT_LE((RotationVector(rotation.toRotationMatrix()) - phi).norm(), 1e-7 * angle + 1e-15)
        << angle;
  }
}

TEST_F(RotationVectorTest, OfAQuaternionDoesNotDependOnItsSign) {
  const Eigen::Quaterniond rotation(Exponential(0.7 * Direction()));
  const Eigen::Quaterniond negative(-rotation.coeffs());
  EXPECT_LE((RotationVector(rotation) - RotationVector(negative)).norm(), 1e-15);
}

TEST_F(RotationVectorTest, SmallestRotationTurnsOneDirectionIntoAnotherAboutAnAxisAcrossThem) {
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d from = Direction(), to = Direction();
    const Eigen::Quaterniond rotation = SmallestRotation(3 * from, 0.2 * to);
    EXPECT_LE((rotation * from - to).norm(), 1e-14);
    const Vector3d phi = RotationVector(rotation);
    EXPECT_NEAR(phi.norm(), std::acos(from.dot(to)), 1e-7);
    EXPECT_NEAR(phi.dot(from), 0, 1e-14);
  }
}

TEST_F(RotationVectorTest, SmallestRotationOfOppositeDirectionsIsHalfATurn) {
  for (const double departure : {0.0, 1e-13, 1e-8, 1e-5, 1e-3}) {
    const Vector3d from = Direction();
    const Vector3d to = Exponential(departure * from.unitOrthogonal()) * Vector3d(-from);
    const Eigen::Quaterniond rotation = SmallestRotation(from, to);
    EXPECT_NEAR(rotation.norm(), 1, 1e-15) << departure;
    EXPECT_LE((rotation * from - to).norm(), 1e-7) << departure;
    EXPECT_NEAR(RotationVector(rotation).norm(), std::numbers::pi - departure, 1e-7) << departure;
  }
  EXPECT_EQ(RotationVector(SmallestRotation(Vector3d::UnitX(), 2 * Vector3d::UnitX())).norm(), 0);
}

TEST_F(RotationVectorTest, LeftJacobianGivesTheAngularVelocityOfDifferences) {
  for (const double angle : {1e-6, 0.5, 0.999, 1.001, 3.0}) {
    const Vector3d phi = angle * Direction();
    const Vector3d rate = Direction();
    constexpr double kStep = 1e-5;
    const auto rotation = [&](double t) { return Exponential(phi + t * rate).toRotationMatrix(); };
    const Matrix3d turn = rotation(kStep) * rotation(-kStep).transpose();
    const Vector3d expected = RotationVector(turn) / (2 * kStep);
    EXPECT_LE((LeftJacobian(phi) * rate - expected).norm(), 1e-8) << angle;
    const Matrix3d difference =
        (LeftJacobian(phi + kStep * rate) - LeftJacobian(phi - kStep * rate)) / (2 * kStep);
    EXPECT_LE((LeftJacobianRate(phi, rate) - difference).norm(), 1e-8) << angle;
  }
}

}  // namespace
}  // namespace possibility::models
