#include "actions/plan/force_change.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace possibility::actions {
namespace {

using Eigen::Matrix3Xd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Against crosses of the arms, written out.
TEST(WrenchOf, IsTheSumOfForcesAndTheirMoments) {
  Matrix3Xd arms(3, 2);
  arms << 1, 0, 0, 2, 0, 0;
  Matrix3Xd forces(3, 2);
  forces << 0, 0, 0, 0, 3, 5;
  EXPECT_EQ(WrenchOf(arms, forces), (Vector6d() << 10, -3, 0, 0, 0, 8).finished());
}

TEST(LeastForceChange, SuppliesWhatIsMissingWithTheLeastChange) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  constexpr double kWeight = 400;
  for (int trial = 0; trial < 50; ++trial) {
    const int n = 4 + trial % 5;
    Matrix3Xd arms(3, n), forces(3, n), other(3, n);
    for (double& x : arms.reshaped()) x = 0.3 * normal(generator);
    for (double& x : forces.reshaped()) x = 10 * normal(generator);
    forces.row(2) = (kWeight / n) * (forces.row(2).array() / 20).exp();
    Vector6d missing;
    for (double& x : missing) x = 20 * normal(generator);
    const Matrix3Xd change = LeastForceChange(arms, forces, kWeight, missing);
    EXPECT_LT((WrenchOf(arms, change) - missing).norm(), 1e-8);

    // Any other change with the same wrench is larger, each in proportion to the load.
    for (double& x : other.reshaped()) x = normal(generator);
    other += LeastForceChange(arms, forces, kWeight, missing - WrenchOf(arms, other));
    EXPECT_LT((WrenchOf(arms, other) - missing).norm(), 1e-8);
    const auto size = [&](const Matrix3Xd& of) {
      const Eigen::RowVectorXd loads = forces.row(2).array() / kWeight + 1e-3 / n;
      return (of.array().rowwise() / loads.array()).matrix().norm();
    };
    EXPECT_LE(size(change), size(other) * (1 + 1e-9));
  }
}

/// Two points cannot turn the robot about the line between them.
TEST(LeastForceChange, LeavesWhatThePointsCannotSupply) {
  Matrix3Xd arms(3, 2);
  arms << -1, 1, 0, 0, 0, 0;
  const Matrix3Xd forces = Eigen::Vector3d(0, 0, 100).replicate(1, 2);
  Vector6d missing;
  missing << 5, 7, 0, 0, 0, 10;
  const Vector6d left = missing - WrenchOf(arms, LeastForceChange(arms, forces, 200, missing));
  EXPECT_NEAR(left[0], 5, 1e-9);
  EXPECT_LT(left.tail(5).norm(), 1e-9);
}

}  // namespace
}  // namespace possibility::actions
