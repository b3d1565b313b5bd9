#include "collocation/robot/swing_clearance.h"

#include <gtest/gtest.h>

#include <random>

#include "dynamics/tree/multibody_model.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::collocation {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kClearance = 0.05;  // m

/// A body without joints that swings its patch of two points, which are at its origin and 0.1 m to
/// the side, so that q gives their places.
struct Swinging {
  explicit Swinging(const Vector3d& way) {
    std::mt19937 random(1);
    models::RobotModel body = dynamics::RandomTree(&random, 0);
    models::ContactPatch patch;
    patch.name = "patch";
    patch.points = {Vector3d::Zero(), Vector3d(0, 0.1, 0)};
    body.contacts = {patch};
    model = dynamics::MultibodyModel::OnJoints(body);
    Eigen::Isometry3d place = body.contacts[0].Frame();
    const PlacedPatch from = Place(*model, 0, place);
    place.pretranslate(way);
    clearance = SwingClearance(model, from, Place(*model, 0, place), {0, 1, kClearance});
  }

  /// Of the first point at `place`.
  double At(const Vector3d& place, double share) const {
    VectorXd z = VectorXd::Zero(7);
    z.head<3>() = place;
    z[6] = share;
    VectorXd y(2);
    clearance->Evaluate(z, &y);
    EXPECT_NEAR(y[0], y[1], 1e-12);
    return y[0];
  }

  RobotSystem model;
  std::shared_ptr<Function> clearance;
};

TEST(SwingClearanceTest, OnTheLevelTheHillGoesByTime) {
  const Swinging swing({0.4, 0, 0});
  for (const double x : {0.0, 0.1, 0.4}) {
    EXPECT_NEAR(swing.At({x, 0, 0.03}, 0), 0.03, 1e-12);
    EXPECT_NEAR(swing.At({x, 0, 0.03}, 0.5), 0.03 - kClearance, 1e-12);
    EXPECT_NEAR(swing.At({x, 0, 0.03}, 1), 0.03, 1e-12);
  }
}

TEST(SwingClearanceTest, AStepUpIsClearedFromTheFirst15PerCentOfTheWay) {
  const Swinging swing({0.4, 0, 0.1});
  for (const double share : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(swing.At({0, 0, 0.02}, share), 0.02, 1e-12);
    for (const double x : {0.06, 0.1, 0.2, 0.3, 0.4}) {
      EXPECT_LE(swing.At({x, 0, 0.1}, share), 1e-12);
    }
    EXPECT_NEAR(swing.At({0.2, 0, 0.1}, share), -kClearance, 1e-12);
    EXPECT_NEAR(swing.At({0.4, 0, 0.1}, share), 0, 1e-12);
  }
}

TEST(SwingClearanceTest, AStepDownIsClearedUntilTheLast15PerCentOfTheWay) {
  const Swinging down({0, 0.4, -0.1});
  const Swinging up({0, -0.4, 0.1});
  for (const double y : {0.0, 0.05, 0.2, 0.31, 0.36, 0.4}) {
    EXPECT_NEAR(down.At({0, y, 0.01}, 0.5), up.At({0, y - 0.4, 0.11}, 0.5), 1e-12);
  }
}

TEST(SwingClearanceTest, DerivativesAgreeWithDifferences) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0.05, 0.95);
  for (int trial = 0; trial < 60; ++trial) {
    const Vector3d way(0.4, trial % 2 == 0 ? 0.1 : 0,
                       trial % 3 == 0 ? 0 : 0.1 - 0.05 * (trial % 3));
    const Swinging swing(way);
    VectorXd z = dynamics::RandomVector(&random, 7, 0.4);
    // Within the way and off the ends of the steps, where only two derivatives are continuous.
    z.head<3>() = share(random) * way;
    z[6] = share(random);
    ExpectExactDerivatives(swing.clearance.get(), z, dynamics::RandomVector(&random, 2, 1));
  }
}

}  // namespace
}  // namespace possibility::collocation
