#include "dynamics/contact/contact_patches.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "dynamics/contact/quadratic_program.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

std::vector<HeldPoint> Rectangle(int link, double x, double y) {
  std::vector<HeldPoint> points;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      points.push_back({{.link = link}, {sx * x, sy * y, 0}});
    }
  }
  return points;
}

TEST(ContactPatches, RectangleHasFourEdges) {
  const auto patches = MakePatches(Rectangle(0, 0.2, 0.1));
  ASSERT_EQ(patches.size(), 1);
  ASSERT_EQ(patches[0].edges.size(), 4);
  for (const TippingEdge& edge : patches[0].edges) {
    EXPECT_DOUBLE_EQ(edge.levers.sum(), 2);
    EXPECT_DOUBLE_EQ(edge.levers.maxCoeff(), 1);
  }
}

TEST(ContactPatches, PointsOnALineTipAboutTheirEndsAndAPointLiftsOff) {
  std::vector<HeldPoint> line;
  for (const double x : {0.0, 1.0, 4.0}) line.push_back({{}, {x, 2 * x, 0}});
  const auto patches = MakePatches(line);
  ASSERT_EQ(patches[0].edges.size(), 2);
  EXPECT_LT((patches[0].edges[0].levers - Vector3d(0, 0.25, 1)).norm(), 1e-12);
  EXPECT_LT((patches[0].edges[1].levers - Vector3d(1, 0.75, 0)).norm(), 1e-12);
  const auto single = MakePatches({line[0]});
  ASSERT_EQ(single[0].edges.size(), 1);
  Matrix3Xd force(3, 1);
  force << 1, 2, 3;
  EXPECT_DOUBLE_EQ(single[0].Moment(single[0].edges[0], force), 3);
}

TEST(ContactPatches, PointsOfOtherLinksOrPlanesAreOtherPatches) {
  std::vector<HeldPoint> points = Rectangle(0, 1, 1);
  points[1].point.link = 1;
  points[2].point.normal_W = Vector3d::UnitX();
  const auto patches = MakePatches(points);
  ASSERT_EQ(patches.size(), 3);
  EXPECT_EQ(patches[0].points, (std::vector<int>{0, 3}));
}

TEST(ContactPatches, FrictionUtilisationIsTheRatioToTheConesLimit) {
  const auto patches = MakePatches(Rectangle(0, 1, 1));
  Matrix3Xd forces = Matrix3Xd::Zero(3, 4);
  EXPECT_EQ(patches[0].FrictionUtilisation(forces, 0.5), 0);
  forces.row(0).setConstant(3);
  forces.row(1).setConstant(-4);
  forces.row(2).setConstant(20);
  EXPECT_DOUBLE_EQ(patches[0].FrictionUtilisation(forces, 0.5), 0.5);
  forces.row(2).setConstant(-20);
  EXPECT_EQ(patches[0].FrictionUtilisation(forces, 0.5), std::numeric_limits<double>::infinity());
}

/// Whether some normal forces >= 0 at the points have the resultant and moments of `forces`. A
/// quadratic program decides, which knows nothing of edges.
bool CanPush(const std::vector<HeldPoint>& points, const Matrix3Xd& forces) {
  const int count = static_cast<int>(points.size());
  QuadraticProgram program;
  program.H.setIdentity(count, count);
  program.g.setZero(count);
  program.E.resize(3, count);
  for (int i = 0; i < count; ++i) program.E.col(i) << 1, points[i].anchor.x(), points[i].anchor.y();
  program.e = program.E * forces.row(2).transpose();
  program.C = -Eigen::MatrixXd::Identity(count, count);
  program.d.setZero(count);
  return Solve(program).status == QuadraticProgramStatus::kSolved;
}

TEST(ContactPatches, MomentsArePositiveExactlyWhereThePointsNeedNotPull) {
  std::mt19937 random(5);
  int can = 0, cannot = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int count = 3 + trial % 5;
    std::vector<HeldPoint> points;
    for (int i = 0; i < count; ++i) {
      Vector3d p = RandomVector(&random, 3, 1);
      p.z() = 0.3;
      points.push_back({{.link = 2}, p});
    }
    Matrix3Xd forces(3, count);
    for (double& f : forces.reshaped()) f = Uniform(&random, -0.6, 1.4);
    const auto patches = MakePatches(points);
    double least = std::numeric_limits<double>::infinity();
    for (const TippingEdge& edge : patches[0].edges) {
      least = std::min(least, patches[0].Moment(edge, forces));
    }
    if (std::abs(least) < 1e-6) continue;
    EXPECT_EQ(least > 0, CanPush(points, forces)) << "trial " << trial << ", least " << least;
    ++(least > 0 ? can : cannot);
  }
  EXPECT_GT(can, 50);
  EXPECT_GT(cannot, 50);
}

}  // namespace
}  // namespace possibility::dynamics
