#include "dynamics/contact/bearing_points.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A rigid body of mass 1 and inertia `inertia` about all axes, with v = (angular, linear) of its
/// centre and contact points at `offsets` from there. `motion` (6) is its motion without contacts.
UnilateralContacts Body(double inertia, const std::vector<Vector3d>& offsets,
                        const VectorXd& motion) {
  UnilateralContacts contacts;
  contacts.mass.setIdentity(6, 6);
  contacts.mass.topLeftCorner(3, 3) *= inertia;
  contacts.jacobian.resize(3 * offsets.size(), 6);
  for (size_t i = 0; i < offsets.size(); ++i) {
    const Vector3d& r = offsets[i];
    contacts.jacobian.middleRows<3>(3 * i) << 0, r.z(), -r.y(), 1, 0, 0,  //
        -r.z(), 0, r.x(), 0, 1, 0,                                        //
        r.y(), -r.x(), 0, 0, 0, 1;
  }
  contacts.unconstrained = contacts.jacobian * motion;
  contacts.normals.assign(offsets.size(), Vector3d::UnitZ());
  return contacts;
}

const std::vector<Vector3d> kCorners = {
    {-0.2, -0.1, -0.1}, {-0.2, 0.1, -0.1}, {0.2, -0.1, -0.1}, {0.2, 0.1, -0.1}};

VectorXd Motion(double wx, double wy, double vx, double vz) {
  VectorXd motion(6);
  motion << wx, wy, 0, vx, 0, vz;
  return motion;
}

TEST(BearingPoints, FlatFallBearsOnAllPoints) {
  const BearingSelection bearing = SelectBearingPoints(Body(0.01, kCorners, Motion(0, 0, 0, -1)));
  EXPECT_EQ(bearing.points, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(bearing.jammed.empty());
}

TEST(BearingPoints, RisingBodyBearsOnNone) {
  EXPECT_TRUE(SelectBearingPoints(Body(0.01, kCorners, Motion(0, 0, 0, 1))).points.empty());
  EXPECT_TRUE(SelectBearingPoints({MatrixXd::Identity(6, 6), MatrixXd(0, 6), VectorXd(), {}, 0})
                  .points.empty());
}

TEST(BearingPoints, TurningBodyBearsOnOneEdge) {
  const BearingSelection bearing = SelectBearingPoints(Body(0.01, kCorners, Motion(0, 20, 0, 1)));
  EXPECT_EQ(bearing.points, (std::vector<int>{2, 3}));
}

TEST(BearingPoints, PointsBelowTheStayingVelocityBear) {
  UnilateralContacts contacts = Body(0.01, kCorners, Motion(0, 0, 0, 1e-3));
  EXPECT_TRUE(SelectBearingPoints(contacts).points.empty());
  contacts.staying = 2e-3;
  EXPECT_EQ(SelectBearingPoints(contacts).points.size(), 4);
}

TEST(BearingPoints, ABodyPushedAlongBearsOnAllPointsOrItsFrontEdge) {
  // A tall body pushed along. Friction does not let it slide, so it turns over its front edge.
  const BearingSelection tips = SelectBearingPoints(Body(0.01, kCorners, Motion(0, 0, 5, -1)));
  EXPECT_EQ(tips.points, (std::vector<int>{2, 3}));
  const BearingSelection stays = SelectBearingPoints(Body(0.01, kCorners, Motion(0, 0, 0.5, -1)));
  EXPECT_EQ(stays.points.size(), 4);
}

/// The motion that results if the points are held, and the forces that hold them.
VectorXd Held(const UnilateralContacts& contacts, const std::vector<int>& points,
              VectorXd* forces) {
  std::vector<int> rows;
  for (const int p : points) rows.insert(rows.end(), {3 * p, 3 * p + 1, 3 * p + 2});
  const MatrixXd G = contacts.jacobian * contacts.mass.inverse() * contacts.jacobian.transpose();
  VectorXd motion = contacts.unconstrained;
  forces->resize(0);
  if (rows.empty()) return motion;
  *forces = -MatrixXd(G(rows, rows))
                 .completeOrthogonalDecomposition()
                 .solve(VectorXd(contacts.unconstrained(rows)));
  motion += G(Eigen::all, rows) * *forces;
  return motion;
}

TEST(BearingPoints, RandomBodiesMeetTheConditionsOfContactOrAreJammed) {
  // Three points at most, so that forces are unique and signs can be checked one by one.
  std::mt19937 random(6);
  int jammed = 0, bears[4] = {};
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Vector3d> offsets;
    for (int i = 0; i < 1 + trial % 3; ++i) {
      Vector3d offset = RandomVector(&random, 3, 1);
      offset.z() = -0.7;
      offsets.push_back(offset);
    }
    const UnilateralContacts contacts =
        Body(Uniform(&random, 0.05, 1), offsets, RandomVector(&random, 6, 1));
    const BearingSelection bearing = SelectBearingPoints(contacts);
    VectorXd forces;
    const VectorXd motion = Held(contacts, bearing.points, &forces);
    for (int i = 0; i < static_cast<int>(offsets.size()); ++i) {
      EXPECT_GE(motion[3 * i + 2], -1e-5) << "a point enters the ground";
    }
    ++bears[bearing.points.size()];
    if (!bearing.jammed.empty()) {
      ++jammed;
      continue;
    }
    // Normal forces of points on one link are unique for up to three points not on a line.
    for (size_t i = 0; i < bearing.points.size(); ++i) {
      EXPECT_GE(forces[3 * i + 2], -1e-5) << "a point pulls, trial " << trial;
    }
  }
  EXPECT_GT(bears[0], 100);
  EXPECT_GT(bears[1], 100);
  EXPECT_GT(bears[2], 50);
  EXPECT_LT(jammed, 400);
}

TEST(BearingPoints, ARodIsJammedExactlyIfItsForcePulls) {
  // Painleve's rod. At rest it would fall onto its tip. If it turns fast enough, the tip needs a
  // pull to stay, while friction would lift it.
  const double lean = 0.9;
  const Vector3d tip(-std::sin(lean), 0, -std::cos(lean));
  const UnilateralContacts contacts = Body(0.05, {tip}, Motion(0, 0, 3, -0.5));
  const BearingSelection bearing = SelectBearingPoints(contacts);
  ASSERT_EQ(bearing.points, std::vector<int>{0});
  VectorXd forces;
  Held(contacts, bearing.points, &forces);
  EXPECT_EQ(bearing.jammed.empty(), forces[2] >= 0);
}

TEST(BearingPoints, InvalidArgumentsAreRefused) {
  UnilateralContacts contacts = Body(0.01, kCorners, Motion(0, 0, 0, -1));
  contacts.unconstrained[3] = NAN;
  EXPECT_THROW(SelectBearingPoints(contacts), std::invalid_argument);
  contacts.unconstrained.resize(3);
  EXPECT_THROW(SelectBearingPoints(contacts), std::invalid_argument);
  contacts = Body(0.01, kCorners, Motion(0, 0, 0, -1));
  contacts.mass(0, 0) = -1;
  EXPECT_THROW(SelectBearingPoints(contacts), std::invalid_argument);
  contacts.staying = NAN;
  EXPECT_THROW(SelectBearingPoints(contacts), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
