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

std::vector<ContactPoint> TwoPoints(std::mt19937* random, const RobotSystem& model) {
  const int links = model->tree().num_links();
  return {{links - 1, dynamics::RandomVector(random, 3, 0.3)},
          {static_cast<int>((*random)() % links), dynamics::RandomVector(random, 3, 0.3)}};
}

/// In turn a planar tree and one on joints in space, some of them with a locked or a mimic joint.
RobotSystem SomeSystem(std::mt19937* random, int trial) {
  const int joints = 1 + trial / 2 % 6;
  if (trial % 2 == 0) {
    const models::RobotModel tree = dynamics::RandomPlanarTree(random, joints);
    return dynamics::MultibodyModel::Planar(trial % 4 == 0 ? tree
                                                           : dynamics::WithActuators(tree, random));
  }
  models::RobotModel tree = dynamics::RandomTree(random, joints);
  if (joints > 3) tree.joints[1].mimic = models::Mimic{3, -2, 0.5};
  if (trial % 4 == 1) tree = dynamics::WithActuators(tree, random);
  return joints > 2 ? dynamics::MultibodyModel::OnJoints(tree, {{2, 0.7}})
                    : dynamics::MultibodyModel::OnJoints(tree);
}

TEST(MultibodyFunctionsTest, DerivativesAgreeWithDifferences) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 40; ++trial) {
    const RobotSystem model = SomeSystem(&random, trial);
    const auto points = TwoPoints(&random, model);
    const std::vector<PointComponent> components = {{points[0], Eigen::Vector3d(0.6, 0, 0.8)},
                                                    {points[1], Eigen::Vector3d::UnitZ()},
                                                    {points[1], Eigen::Vector3d::UnitX()}};
    const std::vector<PointOverPlane> planes = {
        {points[0], points[1], Eigen::Vector3d(0.6, 0, 0.8)},
        {points[1], {model->tree().num_links() - 1, {0.1, 0, 0}}, Eigen::Vector3d::UnitZ()}};
    const std::vector<TorqueSpeedRow> lines = {{model->num_joints() - 1, 0.7}, {0, 2}};
    for (const auto& f :
         {EquationOfMotion(model, points), EquationOfMotion(model, points, lines),
          ActuatedMotion(model, points), PointPositions(model, points),
          PointPositions(model, components), PointVelocities(model, points),
          PointVelocities(model, components), PointAccelerations(model, points),
          PointAccelerations(model, components), SquaredDistance(model, points[0], points[1]),
          HeightsOverPlanes(model, planes), ImpactMap(model, points)}) {
      ExpectExactDerivatives(f.get(), dynamics::RandomVector(&random, f->num_inputs(), 1.5),
                             dynamics::RandomVector(&random, f->num_outputs(), 1));
    }
  }
}

TEST(MultibodyFunctionsTest, BranchesAreMaskedFromEachOther) {
  // Two branches of one joint each: neither's torque depends on the other's motion, given the
  // root's.
  std::mt19937 random(8);
  models::RobotModel tree = dynamics::RandomTree(&random, 2);
  for (models::Joint& joint : tree.joints) joint.parent = 0;
  const auto model = dynamics::MultibodyModel::OnJoints(tree);
  const auto motion = EquationOfMotion(model, {});
  for (const int part : {0, 8, 16}) {
    EXPECT_FALSE(motion->JacobianMask()(6, part + 7));
    EXPECT_FALSE(motion->JacobianMask()(7, part + 6));
    EXPECT_FALSE(motion->HessianMask()(6, part + 7));
    EXPECT_TRUE(motion->JacobianMask()(6, part + 6));
  }
  const auto distance = SquaredDistance(model, {7, {0.1, 0, 0}}, {6, {0, 0, 0.1}});
  EXPECT_EQ(distance->JacobianMask().count(), 1);
}

TEST(MultibodyFunctionsTest, TorquesAreWhatInverseDynamicsAsks) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 20; ++trial) {
    const RobotSystem model = SomeSystem(&random, trial);
    const auto points = TwoPoints(&random, model);
    const auto inverse = EquationOfMotion(model, points);
    const auto actuated = ActuatedMotion(model, points);
    VectorXd z = dynamics::RandomVector(&random, actuated->num_inputs(), 1.5);
    VectorXd torques(model->nv());
    inverse->Evaluate(z.head(inverse->num_inputs()), &torques);
    z.tail(model->num_joints()) = torques.tail(model->num_joints());
    VectorXd residual(model->nv());
    actuated->Evaluate(z, &residual);
    const int base = model->num_base_velocities();
    EXPECT_EQ(residual.head(base), torques.head(base));
    EXPECT_EQ(residual.tail(model->num_joints()), VectorXd::Zero(model->num_joints()));
  }
}

TEST(MultibodyFunctionsTest, ForwardDynamicsSolvesTheEquationOfMotion) {
  std::mt19937 random(2);
  const RobotSystem model =
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
    const RobotSystem model =
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
    const RobotSystem model =
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
    const RobotSystem model =
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
  const RobotSystem model =
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

TEST(MultibodyFunctionsTest, RefusesABaseWithAQuaternion) {
  std::mt19937 random(4);
  const auto model = dynamics::MultibodyModel::Spatial(dynamics::RandomTree(&random, 2));
  const std::vector<ContactPoint> no_points;
  EXPECT_THROW(PointAccelerations(model, no_points), std::invalid_argument);
  EXPECT_THROW(SquaredDistance(model, {}, {}), std::invalid_argument);
  EXPECT_THROW(EquationOfMotion(model, no_points), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::collocation
