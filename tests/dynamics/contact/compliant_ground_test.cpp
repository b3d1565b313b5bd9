#include "dynamics/contact/compliant_ground.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A point in random ground that moves slowly.
struct Case {
  CompliantGround ground;
  double friction = 0;
  Vector3d normal, position, velocity;

  GroundReaction At(const Vector3d& moved, const Vector3d& faster) const {
    return ReactionOf(ground, friction, normal, normal.dot(position + moved), velocity + faster);
  }
};

Case RandomCase(std::mt19937* random) {
  Case sample;
  sample.friction = Uniform(random, 0.2, 1.2);
  sample.normal = RandomVector(random, 3, 1).normalized();
  sample.position = -Uniform(random, 1e-5, 1e-3) * sample.normal;
  sample.velocity = RandomVector(random, 3, std::pow(10, Uniform(random, -5, -2)));
  return sample;
}

TEST(CompliantGround, DerivativesAreThoseOfTheForce) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Case sample = RandomCase(&random);
    const GroundReaction reaction = sample.At(Vector3d::Zero(), Vector3d::Zero());
    Matrix3d to_position, to_velocity;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d x = 1e-8 * Vector3d::Unit(axis), v = 1e-8 * Vector3d::Unit(axis);
      to_position.col(axis) =
          (sample.At(x, Vector3d::Zero()).force - sample.At(-x, Vector3d::Zero()).force) / 2e-8;
      to_velocity.col(axis) =
          (sample.At(Vector3d::Zero(), v).force - sample.At(Vector3d::Zero(), -v).force) / 2e-8;
    }
    EXPECT_LT((reaction.to_position - to_position).norm(), 1e-5 * to_position.norm());
    EXPECT_LT((reaction.to_velocity - to_velocity).norm(), 1e-5 * to_velocity.norm());
  }
}

TEST(CompliantGround, TheForceAloneIsThatOfTheReaction) {
  std::mt19937 random(7);
  int bearing = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Case sample = RandomCase(&random);
    const Vector3d velocity = RandomVector(&random, 3, 0.05);
    const double gap = Uniform(&random, -1e-3, 3e-4);
    const Vector3d force = ForceOf(sample.ground, sample.friction, sample.normal, gap, velocity);
    EXPECT_EQ(force,
              ReactionOf(sample.ground, sample.friction, sample.normal, gap, velocity).force);
    bearing += force.norm() > 0;
  }
  EXPECT_GT(bearing, 50);
  EXPECT_LT(bearing, 195);
}

TEST(CompliantGround, PushesWithinTheFrictionConeAndBrakesSliding) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Case sample = RandomCase(&random);
    const Vector3d force = sample.At(Vector3d::Zero(), Vector3d::Zero()).force;
    const double load = sample.normal.dot(force);
    const Vector3d across = force - load * sample.normal;
    EXPECT_GT(load, 0);
    EXPECT_LT(across.norm(), sample.friction * load);
    EXPECT_LT(across.dot(sample.velocity), 0);
  }
}

TEST(CompliantGround, FrictionComesCloseToItsLimitWhereAPointSlides) {
  const GroundReaction reaction =
      ReactionOf({}, 0.7, Vector3d::UnitZ(), -1e-4, Vector3d(0.05, 0, 0));
  EXPECT_NEAR(-reaction.force.x() / reaction.force.z(), 0.7, 1e-4);
}

TEST(CompliantGround, NeitherPullsNorActsFromAfar) {
  const CompliantGround ground;
  EXPECT_EQ(ReactionOf(ground, 0.7, Vector3d::UnitZ(), 1e-6, Vector3d(0, 0, -1)).force.norm(), 0);
  EXPECT_EQ(ReactionOf(ground, 0.7, Vector3d::UnitZ(), -1e-4, Vector3d(0, 0, 1)).force.norm(), 0);
}

}  // namespace
}  // namespace possibility::dynamics
