#include "actions/plan/interpolation.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/actions/plan/random_plan.h"

namespace possibility::actions {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::RandomKnot;

Quaterniond Root(const Knot& knot) {
  return Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
}

Vector3d Log(const Quaterniond& R) {
  const AngleAxisd turn(R);
  const double angle = std::remainder(turn.angle(), 2 * std::numbers::pi);
  return angle * turn.axis();
}

Quaterniond Exp(const Vector3d& phi) {
  return phi.norm() > 0 ? Quaterniond(AngleAxisd(phi.norm(), phi.normalized()))
                        : Quaterniond::Identity();
}

/// Velocity between two close states, to second order in their distance.
VectorXd Difference(const Knot& before, const Knot& after) {
  VectorXd v(before.v.size());
  v << Log(Root(after) * Root(before).conjugate()),
      after.q.tail(after.q.size() - 4) - before.q.tail(before.q.size() - 4);
  return v / (after.t - before.t);
}

/// Two random knots whose orientations are `angle` apart.
std::pair<Knot, Knot> RandomPair(double angle, std::mt19937* generator) {
  const Knot k0 = RandomKnot(2.0, 5, 4, generator);
  Knot k1 = RandomKnot(2.1, 5, 4, generator);
  const Vector3d axis = k1.v.head<3>().normalized();
  const Quaterniond R1 = Quaterniond(AngleAxisd(angle, axis)) * Root(k0);
  k1.q.head<4>() << R1.w(), R1.vec();
  return {k0, k1};
}

TEST(Interpolate, JointsAloneAreThoseOfTheWholeMotion) {
  std::mt19937 generator(12);
  for (int trial = 0; trial < 20; ++trial) {
    const auto [k0, k1] = RandomPair(0.3, &generator);
    const KnotInterpolant interpolant(k0, k1);
    for (const double t : {1.9, 2.0, 2.013, 2.05, 2.0999, 2.1, 2.3}) {
      const Knot knot = interpolant.At(t);
      VectorXd position, velocity, torque;
      interpolant.JointsAt(t, &position, &velocity, &torque);
      const auto n = static_cast<int>(position.size());
      ASSERT_EQ(n, knot.q.size() - 7);
      EXPECT_LT((position - knot.q.tail(n)).norm(), 1e-14 * (1 + position.norm()));
      EXPECT_LT((velocity - knot.v.tail(n)).norm(), 1e-14 * (1 + velocity.norm()));
      EXPECT_EQ(torque, knot.tau);
    }
  }
}

TEST(Interpolate, ReturnsTheKnotsAtBothEnds) {
  std::mt19937 generator(2);
  const auto [k0, k1] = RandomPair(0.4, &generator);
  for (const Knot* knot : {&k0, &k1}) {
    const Knot at = Interpolate(k0, k1, knot->t);
    EXPECT_EQ(at.q, knot->q);
    EXPECT_EQ(at.v, knot->v);
    EXPECT_EQ(at.a, knot->a);
    EXPECT_EQ(at.tau, knot->tau);
    EXPECT_EQ(at.forces, knot->forces);
  }
}

TEST(Interpolate, ConfigurationAloneIsTheSame) {
  std::mt19937 generator(7);
  const auto [k0, k1] = RandomPair(0.9, &generator);
  const KnotInterpolant between(k0, k1);
  for (int i = -1; i <= 21; ++i) {
    const double t = k0.t + (k1.t - k0.t) * i / 20;
    EXPECT_EQ(between.ConfigurationAt(t), between.At(t).q) << t;
  }
}

TEST(Interpolate, ApproachesTheKnotsInPositionVelocityAndAcceleration) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 200; ++trial) {
    const auto [k0, k1] = RandomPair(trial * 0.0155, &generator);
    for (const auto& [knot, t] : {std::pair(&k0, k0.t + 1e-10), std::pair(&k1, k1.t - 1e-10)}) {
      const Knot at = Interpolate(k0, k1, t);
      EXPECT_LT(Root(at).angularDistance(Root(*knot)), 1e-7);
      EXPECT_LT((at.q - knot->q).tail(8).norm(), 1e-8);
      EXPECT_LT((at.v - knot->v).norm(), 1e-5);
      EXPECT_LT((at.a - knot->a).norm(), 1e-2);
    }
  }
}

TEST(Interpolate, VelocityAndAccelerationAreTheDerivatives) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> inside(0.01, 0.99);
  for (int trial = 0; trial < 300; ++trial) {
    const auto [k0, k1] = RandomPair(trial * 0.003, &generator);
    const double t = k0.t + inside(generator) * (k1.t - k0.t);
    const double e = 1e-6;
    const Knot before = Interpolate(k0, k1, t - e);
    const Knot at = Interpolate(k0, k1, t);
    const Knot after = Interpolate(k0, k1, t + e);
    const double speed = 1 + at.v.norm();
    EXPECT_NEAR(at.q.head<4>().norm(), 1, 1e-14);
    EXPECT_LT((at.v - Difference(before, after)).norm(), 1e-6 * speed);
    EXPECT_LT((at.a - (after.v - before.v) / (2 * e)).norm(), 1e-6 * (speed + at.a.norm()) * 10);
  }
}

TEST(Interpolate, ReproducesAConstantTwist) {
  std::mt19937 generator(5);
  for (int trial = 0; trial < 100; ++trial) {
    Knot k0 = RandomKnot(0, 3, 0, &generator);
    k0.a.setZero();
    Knot k1 = k0;
    k1.t = 0.3;
    const Vector3d omega = k0.v.head<3>();
    const Quaterniond R1 = Exp(0.3 * omega) * Root(k0);
    k1.q << R1.w(), R1.vec(), k0.q.tail(6) + 0.3 * k0.v.tail(6);
    for (const double t : {0.05, 0.15, 0.29}) {
      const Knot at = Interpolate(k0, k1, t);
      EXPECT_LT(Root(at).angularDistance(Exp(t * omega) * Root(k0)), 1e-7);
      EXPECT_LT((at.q.tail(6) - k0.q.tail(6) - t * k0.v.tail(6)).norm(), 1e-12);
      EXPECT_LT((at.v - k0.v).norm(), 1e-10);
      EXPECT_LT(at.a.norm(), 1e-8);
    }
  }
}

TEST(Interpolate, DoesNotDependOnTheSignOfAQuaternion) {
  std::mt19937 generator(6);
  auto [k0, k1] = RandomPair(0.7, &generator);
  const Knot at = Interpolate(k0, k1, 2.03);
  k1.q.head<4>() *= -1;
  EXPECT_LT((Interpolate(k0, k1, 2.03).q - at.q).norm(), 1e-14);
}

TEST(Interpolate, TorquesAndForcesAreLinear) {
  std::mt19937 generator(7);
  const auto [k0, k1] = RandomPair(0.1, &generator);
  const Knot at = Interpolate(k0, k1, 2.075);
  EXPECT_LT((at.tau - 0.25 * k0.tau - 0.75 * k1.tau).norm(), 1e-10);
  EXPECT_LT((at.forces - 0.25 * k0.forces - 0.75 * k1.forces).norm(), 1e-9);
}

TEST(Interpolate, RefusesKnotsOfDifferentSizesOrEqualTimes) {
  std::mt19937 generator(8);
  const Knot k0 = RandomKnot(0, 3, 4, &generator);
  EXPECT_THROW(Interpolate(k0, RandomKnot(1, 4, 4, &generator), 0.5), std::invalid_argument);
  EXPECT_THROW(Interpolate(k0, RandomKnot(1, 3, 5, &generator), 0.5), std::invalid_argument);
  EXPECT_THROW(Interpolate(k0, RandomKnot(0, 3, 4, &generator), 0), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::actions
