#include "collocation/robot/multibody_functions.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "collocation/robot/balance_functions.h"
#include "collocation/robot/point_functions.h"
#include "dynamics/forward/forward_dynamics.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/richardson.h"

namespace possibility::collocation {
namespace {

using dynamics::ContactPoint;
using dynamics::RelativeError;
using Eigen::VectorXd;

std::vector<ContactPoint> TwoPoints(std::mt19937* random, const PlanarModel& model) {
  const int links = model->tree().num_links();
  return {{links - 1, dynamics::RandomVector(random, 3, 0.3)},
          {static_cast<int>((*random)() % links), dynamics::RandomVector(random, 3, 0.3)}};
}

TEST(MultibodyFunctionsTest, DerivativesAgreeWithDifferences) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const PlanarModel model =
        dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 1 + trial % 6));
    const auto points = TwoPoints(&random, model);
    for (const auto& f : {EquationOfMotion(model, points), PointPositions(model, points),
                          PointVelocities(model, points), PointAccelerations(model, points),
                          SquaredDistance(model, points[0], points[1]), ImpactMap(model, points)}) {
      ExpectExactDerivatives(f.get(), dynamics::RandomVector(&random, f->num_inputs(), 1.5),
                             dynamics::RandomVector(&random, f->num_outputs(), 1));
    }
  }
}

TEST(MultibodyFunctionsTest, ForwardDynamicsSolvesTheEquationOfMotion) {
  std::mt19937 random(2);
  const PlanarModel model =
      dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 5));
  const int n = model->nv();
  const auto f = EquationOfMotion(model, {});
  dynamics::ForwardDynamics forward(model);
  for (int trial = 0; trial < 50; ++trial) {
    VectorXd z = dynamics::RandomVector(&random, 3 * n, 1.5);
    VectorXd torques = dynamics::RandomVector(&random, n, 20);
    torques.head(3).setZero();
    forward.SetState(z.head(n), z.segment(n, n));
    z.tail(n) = forward.Free(torques);
    VectorXd y(n);
    f->Evaluate(z, &y);
    EXPECT_LT(RelativeError(y, torques), 1e-10);
  }
}

TEST(MultibodyFunctionsTest, AnImpactSolvesTheImpactMap) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 50; ++trial) {
    const PlanarModel model =
        dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 4));
    const int n = model->nv();
    const std::vector<ContactPoint> points = {{1, dynamics::RandomVector(&random, 3, 0.3)}};
    dynamics::ForwardDynamics forward(model);
    const VectorXd q = dynamics::RandomVector(&random, n, 1);
    const VectorXd v = dynamics::RandomVector(&random, n, 1);
    forward.SetState(q, v);
    const dynamics::Impact& impact = forward.Hit(points);
    VectorXd z(3 * n + 2);
    z << q, v, impact.velocity, impact.impulses(0, 0), impact.impulses(2, 0);
    VectorXd y(n);
    ImpactMap(model, points)->Evaluate(z, &y);
    EXPECT_LT(y.cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(MultibodyFunctionsTest, PointAccelerationsAndDistancesAgreeWithTheDynamics) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const PlanarModel model =
        dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 1 + trial % 6));
    const int n = model->nv();
    const auto points = TwoPoints(&random, model);
    const VectorXd z = dynamics::RandomVector(&random, 3 * n, 1.5);
    dynamics::MultibodyDynamics motion(model);
    motion.SetState(z.head(n), z.segment(n, n), z.tail(n));
    VectorXd accelerations(4), squared_distance(1);
    PointAccelerations(model, points)->Evaluate(z, &accelerations);
    SquaredDistance(model, points[0], points[1])->Evaluate(z.head(n), &squared_distance);
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d expected = motion.Acceleration(points[i]);
      EXPECT_EQ(accelerations.segment<2>(2 * i), Eigen::Vector2d(expected.x(), expected.z()));
    }
    const Eigen::Vector3d apart = motion.Position(points[0]) - motion.Position(points[1]);
    EXPECT_NEAR(squared_distance[0], apart.squaredNorm(), 1e-14);
  }
}

/// Values of f along the parabola q + v t + a t^2 / 2.
class Along {
 public:
  Along(std::shared_ptr<Function> f, const VectorXd& z) : f_(std::move(f)), z_(z) {}
  VectorXd operator()(double t) const {
    const int n = static_cast<int>(z_.size()) / 3;
    VectorXd y(f_->num_outputs());
    f_->Evaluate(z_.head(n) + t * z_.segment(n, n) + t * t / 2 * z_.tail(n), &y);
    return y;
  }

 private:
  std::shared_ptr<Function> f_;
  VectorXd z_;
};

TEST(MultibodyFunctionsTest, AccelerationsAreSecondDerivativesOfPositionsInTime) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 20; ++trial) {
    const PlanarModel model =
        dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 1 + trial % 6));
    const auto points = TwoPoints(&random, model);
    const VectorXd z = dynamics::RandomVector(&random, 3 * model->nv(), 1.5);
    const Along position(PointPositions(model, points), z);
    constexpr double h = 2e-3;  // fourth-order central differences
    const VectorXd expected = (16 * (position(h) + position(-h)) - position(2 * h) -
                               position(-2 * h) - 30 * position(0)) /
                              (12 * h * h);
    VectorXd accelerations(4);
    PointAccelerations(model, points)->Evaluate(z, &accelerations);
    EXPECT_LT(RelativeError(accelerations, expected), 1e-7);
  }
}

TEST(MultibodyFunctionsTest, DistancesAndAccelerationsAreMaskedWhereNothingDepends) {
  std::mt19937 random(7);
  const PlanarModel model =
      dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 4));
  const int n = model->nv();
  const auto points = TwoPoints(&random, model);
  // No distance within the system changes as its base moves.
  EXPECT_FALSE(SquaredDistance(model, points[0], points[1])->JacobianMask().leftCols(3).any());
  EXPECT_FALSE(SquaredDistance(model, points[0], points[1])->HessianMask().leftCols(3).any());
  // Place and velocity of the base do not affect a point's acceleration. The base's acceleration
  // does.
  const Mask mask = PointAccelerations(model, points)->JacobianMask();
  EXPECT_FALSE(mask.middleCols(1, 2).any());
  EXPECT_FALSE(mask.middleCols(n + 1, 2).any());
  EXPECT_TRUE(mask.middleCols(2 * n + 1, 2).any());
}

TEST(MultibodyFunctionsTest, RefusesASpatialModel) {
  std::mt19937 random(4);
  const auto model = dynamics::MultibodyModel::Spatial(dynamics::RandomTree(&random, 2));
  EXPECT_THROW(PointAccelerations(model, {}), std::invalid_argument);
  EXPECT_THROW(SquaredDistance(model, {}, {}), std::invalid_argument);
  EXPECT_THROW(EquationOfMotion(model, {}), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::collocation
