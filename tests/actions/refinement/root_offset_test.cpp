#include "actions/refinement/root_offset.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/actions/plan/random_plan.h"

namespace possibility::actions {
namespace {

constexpr double kStep = 1e-5;  // s, of the differences

Eigen::Quaterniond TurnOf(const Knot& knot) {
  return Eigen::Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
}

/// The knot's motion a moment later, with its accelerations staying.
Knot Later(const Knot& knot, double dt) {
  Knot later = knot;
  const Eigen::Vector3d turn =
      dt * knot.v.head<3>() + dt * dt / 2 * knot.a.head<3>() +
      dt * dt * dt / 12 *
          Eigen::Vector3d(knot.v.head<3>()).cross(Eigen::Vector3d(knot.a.head<3>()));
  const Eigen::Quaterniond R = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * TurnOf(knot);
  later.q.head<4>() << R.w(), R.vec();
  later.q.tail(later.q.size() - 4) +=
      dt * knot.v.tail(knot.v.size() - 3) + dt * dt / 2 * knot.a.tail(knot.a.size() - 3);
  later.v += dt * knot.a;
  return later;
}

RootOffset Later(const RootOffset& offset, double dt) {
  return {offset.value + dt * offset.rate + dt * dt / 2 * offset.acceleration,
          offset.rate + dt * offset.acceleration, offset.acceleration};
}

class MovedRoot : public ::testing::Test {
 protected:
  MovedRoot() {
    std::mt19937 generator(17);
    knot_ = testing::RandomKnot(1, 2, 0, &generator);
    std::normal_distribution<double> normal;
    for (Vector6d* part : {&offset_.value, &offset_.rate, &offset_.acceleration}) {
      for (double& number : *part) number = 0.3 * normal(generator);
    }
  }

  Knot knot_;
  RootOffset offset_;
};

TEST_F(MovedRoot, VelocitiesAndAccelerationsAreDerivatives) {
  const Knot moved = Moved(knot_, offset_);
  const Knot before = Moved(Later(knot_, -kStep), Later(offset_, -kStep));
  const Knot after = Moved(Later(knot_, kStep), Later(offset_, kStep));
  const Eigen::AngleAxisd turn(TurnOf(after) * TurnOf(before).conjugate());
  EXPECT_LT((turn.angle() * turn.axis() / (2 * kStep) - moved.v.head<3>()).norm(), 1e-7);
  EXPECT_LT(((after.q - before.q).tail(5) / (2 * kStep) - moved.v.tail(5)).norm(), 1e-7);
  EXPECT_LT(((after.v - before.v) / (2 * kStep) - moved.a).norm(), 1e-6);
}

TEST_F(MovedRoot, NothingElseMoves) {
  const Knot moved = Moved(knot_, offset_);
  EXPECT_EQ(moved.q.tail(2), knot_.q.tail(2));
  EXPECT_EQ(moved.v.tail(2), knot_.v.tail(2));
  EXPECT_EQ(moved.a.tail(2), knot_.a.tail(2));
  EXPECT_EQ(moved.t, knot_.t);
}

TEST_F(MovedRoot, TheOffsetIsFoundAgain) {
  const RootOffset found = OffsetBetween(knot_, Moved(knot_, offset_));
  EXPECT_LT((found.value - offset_.value).norm(), 1e-14);
  EXPECT_LT((found.rate - offset_.rate).norm(), 1e-14);
}

TEST_F(MovedRoot, ItsAccelerationChangesTheRootsAsAsked) {
  RootOffset at_rest = offset_;
  at_rest.acceleration.setZero();
  Vector6d change;
  change << 1, -2, 3, 0.5, 0.25, -4;
  RootOffset pushed = at_rest;
  pushed.acceleration = OffsetAcceleration(at_rest, change);
  const Vector6d difference = Moved(knot_, pushed).a.head<6>() - Moved(knot_, at_rest).a.head<6>();
  EXPECT_LT((difference - change).norm(), 1e-13);
}

TEST_F(MovedRoot, FadesFromItsBeginningToNothing) {
  constexpr double kDuration = 0.7;
  const RootOffset begin = Faded(offset_, kDuration, 0);
  EXPECT_LT((begin.value - offset_.value).norm(), 1e-15);
  EXPECT_LT((begin.rate - offset_.rate).norm(), 1e-15);
  EXPECT_EQ(begin.acceleration.norm(), 0);
  const RootOffset end = Faded(offset_, kDuration, 1);
  EXPECT_EQ(end.value.norm() + end.rate.norm() + end.acceleration.norm(), 0);
  for (const double s : {0.1, 0.37, 0.8}) {
    const RootOffset before = Faded(offset_, kDuration, s - kStep / kDuration);
    const RootOffset here = Faded(offset_, kDuration, s);
    const RootOffset after = Faded(offset_, kDuration, s + kStep / kDuration);
    EXPECT_LT(((after.value - before.value) / (2 * kStep) - here.rate).norm(), 1e-7);
    EXPECT_LT(((after.rate - before.rate) / (2 * kStep) - here.acceleration).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace possibility::actions
