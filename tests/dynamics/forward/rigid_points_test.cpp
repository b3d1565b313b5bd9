#include "dynamics/forward/rigid_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d Random(std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(*random), uniform(*random), uniform(*random)};
}

TEST(RigidPoints, BasisHoldsEveryRigidVelocityAndNoOther) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 1 + trial % 6;
    std::vector<ContactPoint> points;
    for (int i = 0; i < count; ++i) points.push_back({3, 0.2 * Random(&random)});
    const std::vector<RigidPoints> groups = GroupByLink(points);
    ASSERT_EQ(groups.size(), 1u);
    const MatrixXd& basis = groups[0].basis;
    EXPECT_EQ(basis.cols(), count == 1 ? 3 : count == 2 ? 5 : 6);
    EXPECT_LT((basis.transpose() * basis - MatrixXd::Identity(basis.cols(), basis.cols())).norm(),
              1e-12);
    const Vector3d turning = Random(&random), moving = Random(&random);
    VectorXd velocities(3 * count);
    for (int i = 0; i < count; ++i) {
      velocities.segment<3>(3 * i) = moving + turning.cross(points[i].p_L);
    }
    EXPECT_LT((basis * (basis.transpose() * velocities) - velocities).norm(), 1e-12);
  }
}

TEST(RigidPoints, PointsOnALineAndAtOnePlaceHaveSmallerBases) {
  const Vector3d p(0.1, 0.2, 0.3), d(0.03, -0.1, 0.02);
  EXPECT_EQ(GroupByLink({{0, p}, {0, p + d}, {0, p + 3 * d}})[0].basis.cols(), 5);
  EXPECT_EQ(GroupByLink({{0, p}, {0, p}})[0].basis.cols(), 3);
  EXPECT_TRUE(GroupByLink({}).empty());
}

TEST(RigidPoints, PointsAreGroupedByLinkWhereverTheyAre) {
  std::mt19937 random(2);
  std::vector<ContactPoint> points;
  for (const int link : {4, 1, 4, 4, 1, 2}) points.push_back({link, Random(&random)});
  const std::vector<RigidPoints> groups = GroupByLink(points);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].points, (std::vector<std::size_t>{0, 2, 3}));
  EXPECT_EQ(groups[1].points, (std::vector<std::size_t>{1, 4}));
  EXPECT_EQ(groups[2].points, (std::vector<std::size_t>{5}));
  EXPECT_EQ(groups[1].link, 1);
  EXPECT_EQ(groups[1].BasisOf(1), groups[1].basis.bottomRows(3));
}

}  // namespace
}  // namespace possibility::dynamics
