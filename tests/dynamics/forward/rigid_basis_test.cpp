#include "dynamics/forward/rigid_basis.h"

#include <gtest/gtest.h>

#include <random>

namespace possibility::dynamics {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d Random(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(*random), uniform(*random), uniform(*random)};
}

std::vector<Isometry3d> RandomPoses(int links, std::mt19937* random) {
  std::vector<Isometry3d> poses(links, Isometry3d::Identity());
  for (Isometry3d& pose : poses) {
    pose.linear() =
        Eigen::AngleAxisd(3 * Random(random).x(), Random(random).normalized()).toRotationMatrix();
    pose.translation() = Random(random);
  }
  return poses;
}

/// Q itself.
MatrixXd Whole(const RigidBasis& basis, int points) {
  MatrixXd Q(3 * points, basis.columns());
  for (Eigen::Index i = 0; i < Q.cols(); ++i)
    Q.col(i) = basis.Expanded(VectorXd::Unit(Q.cols(), i));
  return Q;
}

TEST(RigidBasis, HoldsEveryVelocityOfRigidLinksAndNoOther) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 1 + trial % 9;
    std::vector<ContactPoint> points;
    std::vector<int> on_link(4, 0);
    for (int i = 0; i < count; ++i) {
      points.push_back({static_cast<int>(random() % 4), 0.2 * Random(&random)});
      ++on_link[points.back().link];
    }
    const std::vector<Isometry3d> poses = RandomPoses(4, &random);
    RigidBasis basis;
    basis.SetPoints(points);
    basis.SetPoses(poses);
    Eigen::Index columns = 0;
    for (const int n : on_link) columns += n == 0 ? 0 : n == 1 ? 3 : n == 2 ? 5 : 6;
    EXPECT_EQ(basis.columns(), columns);
    const MatrixXd Q = Whole(basis, count);
    EXPECT_LT((Q.transpose() * Q - MatrixXd::Identity(columns, columns)).norm(), 1e-12);

    VectorXd velocities(3 * count);
    std::vector<Vector3d> turning, moving;
    for (int link = 0; link < 4; ++link) {
      turning.push_back(Random(&random));
      moving.push_back(Random(&random));
    }
    for (int i = 0; i < count; ++i) {
      const int link = points[i].link;
      velocities.segment<3>(3 * i) =
          moving[link] + turning[link].cross(poses[link].linear() * points[i].p_L);
    }
    EXPECT_LT((basis.Expanded(basis.Reduced(velocities)) - velocities).norm(), 1e-12);
    const VectorXd any = VectorXd::Random(3 * count);
    EXPECT_LT((basis.Reduced(any) - Q.transpose() * any).norm(), 1e-12);
    const MatrixXd J = MatrixXd::Random(3 * count, 7);
    MatrixXd reduced;
    basis.Reduce(J, &reduced);
    EXPECT_LT((reduced - J.transpose() * Q).norm(), 1e-12);
  }
}

TEST(RigidBasis, PointsOnALineAndAtOnePlaceHaveFewerColumns) {
  const Vector3d p(0.1, 0.2, 0.3), d(0.03, -0.1, 0.02);
  RigidBasis basis;
  basis.SetPoints({{0, p}, {0, p + d}, {0, p + 3 * d}});
  EXPECT_EQ(basis.columns(), 5);
  basis.SetPoints({{0, p}, {0, p}});
  EXPECT_EQ(basis.columns(), 3);
  basis.SetPoints({});
  EXPECT_EQ(basis.columns(), 0);
}

}  // namespace
}  // namespace possibility::dynamics
