#include "dynamics/contact/cone_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Force and moment about the origin of forces at points: 6 x 3 points.
MatrixXd Wrenches(const Eigen::Matrix3Xd& points) {
  MatrixXd wrenches(6, 3 * points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d force = Vector3d::Unit(k);
      wrenches.col(3 * i + k) << force, points.col(i).cross(force);
    }
  }
  return wrenches;
}

/// Inverse kinematics leaves the toes on a line to some 1e-11 m. Some of these problems had no
/// solution for rounding.
TEST(ConeForcesTest, PointsNearlyOnALineBearWhatPointsOnTheLineBear) {
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Zero(3, 4);
    points.row(1) << -0.15, -0.05, 0.05, 0.15;
    points.colwise() += RandomVector(&random, 3, 1);
    VectorXd forces(12);
    for (int k = 0; k < 4; ++k) {
      const double normal = Uniform(&random, 0.5, 3);
      forces.segment<3>(3 * k) << Uniform(&random, -0.3, 0.3) * normal,
          Uniform(&random, -0.3, 0.3) * normal, normal;
    }
    ConeForceProblem problem;
    problem.normals.assign(4, Vector3d::UnitZ());
    problem.slopes.assign(4, 0.5);
    problem.cone_edges = 16;
    problem.balance_required = Wrenches(points) * forces;
    for (int k = 0; k < 4; ++k) points.col(k) += RandomVector(&random, 3, 1e-11);
    problem.balance_loads = Wrenches(points);
    problem.bounded_loads.resize(0, 12);
    const auto solution = SolveConeForces(problem);
    ASSERT_TRUE(solution) << i;
    EXPECT_LT((problem.balance_loads * *solution - problem.balance_required).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace possibility::dynamics
