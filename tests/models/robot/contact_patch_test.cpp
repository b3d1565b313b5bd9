#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "models/robot/robot_model.h"

namespace possibility::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ContactPatch Sole() {
  ContactPatch patch;
  patch.points = {{0.1, 0.05, -0.1}, {0.1, -0.05, -0.1}, {-0.06, -0.05, -0.1}, {-0.06, 0.05, -0.1}};
  return patch;
}

TEST(ContactPatchFrame, OfASoleHasTheLinksAxesAndTheMeanOfThePoints) {
  const Eigen::Isometry3d X_LP = Sole().Frame();
  EXPECT_LT((X_LP.translation() - Vector3d(0.02, 0, -0.1)).norm(), 1e-12);
  EXPECT_LT((X_LP.linear() - Matrix3d::Identity()).norm(), 1e-12);
}

TEST(ContactPatchFrame, HasZAgainstTheNormalAndXInThePlaneOfTheLinksXAndZ) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  ContactPatch patch = Sole();
  for (int i = 0; i < 1000; ++i) {
    patch.normal_L = Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
    const Matrix3d R = patch.Frame().linear();
    EXPECT_LT((R * R.transpose() - Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    EXPECT_LT((R.col(2) + patch.normal_L).norm(), 1e-12);
    const Vector3d ahead =
        std::abs(patch.normal_L.x()) > 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
    EXPECT_NEAR(R.col(1).dot(ahead), 0, 1e-12);
    EXPECT_GT(R.col(0).dot(ahead), 0.1);
  }
}

}  // namespace
}  // namespace possibility::models
