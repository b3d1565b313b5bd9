#include "actions/wholebody/limb_tilt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "actions/wholebody/whole_body_task.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

class LimbTiltTest : public ::testing::Test {
 protected:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3d Normal() {
    return (AngleAxisd(Uniform(-3, 3), Vector3d::UnitZ()) *
            AngleAxisd(Uniform(0.02, 0.7), Vector3d::UnitX())) *
           Vector3d::UnitZ();
  }

  std::mt19937 random_{3};
};

TEST_F(LimbTiltTest, AnglesAndRotationAreInverse) {
  for (int trial = 0; trial < 100; ++trial) {
    const TurnAngles angles{Uniform(-3, 3), Uniform(-1.5, 1.5), Uniform(-3, 3)};
    const TurnAngles again = AnglesOf(RotationOf(angles));
    EXPECT_NEAR(again.yaw, angles.yaw, 1e-12);
    EXPECT_NEAR(again.pitch, angles.pitch, 1e-12);
    EXPECT_NEAR(again.roll, angles.roll, 1e-12);
  }
}

TEST_F(LimbTiltTest, WhatStandsOnASlopeHasItsNormalAndTheHeading) {
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d normal = Normal();
    const double heading = Uniform(-3, 3);
    const Matrix3d R = StandingOn(normal, heading);
    EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
    EXPECT_LT((R.col(2) - normal).norm(), 1e-14);
    EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), heading, 1e-12);
    EXPECT_FALSE(IsLevel(R));
  }
  const Matrix3d level = StandingOn(Vector3d::UnitZ(), 0.4);
  EXPECT_TRUE(IsLevel(level));
  EXPECT_LT((level - AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix()).norm(), 1e-15);
}

TEST_F(LimbTiltTest, OneSlopeHoldsAllPatchesOfItsPlane) {
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d normal = Normal();
    Eigen::Isometry3d a = Eigen::Isometry3d::Identity();
    a.linear() = StandingOn(normal, Uniform(-3, 3));
    Eigen::Isometry3d b = a;
    b.linear() = StandingOn(normal, Uniform(-3, 3));
    b.translation() += Uniform(-1, 1) * a.linear().col(0) + Uniform(-1, 1) * a.linear().col(1);
    EXPECT_TRUE(BearOnOneSlope(a, b));
    Eigen::Isometry3d above = b;
    above.translation() += 1e-3 * normal;
    EXPECT_FALSE(BearOnOneSlope(a, above));
    Eigen::Isometry3d tipped = b;
    tipped.linear() = AngleAxisd(1e-3, a.linear().col(0)) * b.linear();
    EXPECT_FALSE(BearOnOneSlope(a, tipped));
  }
  EXPECT_FALSE(BearOnOneSlope(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()));
}

/// yaw, pitch and roll over time.
LinkTurn TumblingAt(double t) {
  const auto wave = [t](double amplitude, double rate, double phase) {
    const double angle = rate * t + phase;
    return ScalarSignal{amplitude * std::sin(angle), amplitude * rate * std::cos(angle),
                        -amplitude * rate * rate * std::sin(angle)};
  };
  return TurnedBy(wave(2, 1.3, 0.2), wave(0.6, 2.1, 1), wave(0.8, 1.7, -0.5));
}

TEST_F(LimbTiltTest, RatesOfTurnsAreThoseOfTheOrientation) {
  constexpr double kStep = 1e-5;
  for (double t = 0; t < 4; t += 0.13) {
    const LinkTurn before = TumblingAt(t - kStep);
    const LinkTurn after = TumblingAt(t + kStep);
    const LinkTurn now = TumblingAt(t);
    const Vector3d turned =
        models::RotationVector(after.orientation * before.orientation.transpose());
    EXPECT_LT((turned / (2 * kStep) - now.angular_velocity).norm(), 1e-8);
    EXPECT_LT(((after.angular_velocity - before.angular_velocity) / (2 * kStep) -
               now.angular_acceleration)
                  .norm(),
              1e-7);
  }
}

}  // namespace
}  // namespace possibility::actions
