#include "actions/evidence/derivative_bounds.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/evidence/bounded_maximum.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"
#include "tests/dynamics/newton_euler.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd Random(Eigen::Index size, double scale, std::mt19937* generator) {
  std::normal_distribution<double> normal;
  VectorXd x(size);
  for (double& value : x) value = scale * normal(*generator);
  return x;
}

/// Two knots `gap` apart between which everything moves. Some joints of the robot have been made
/// prismatic.
struct Motion {
  Motion(double gap, double wildness, std::mt19937* generator) : robot(DrcHubo1()) {
    for (models::Joint& joint : robot.joints) {
      if ((*generator)() % 5 == 0) joint.type = models::JointType::kPrismatic;
      if ((*generator)() % 5 == 0) joint.actuator = {2, 3, 4, 0.3, {}};
    }
    const int n = robot.nv();
    k0.q = Random(n + 1, 0.3, generator);
    k0.q.head<4>().normalize();
    k1 = k0;
    k1.t = gap;
    for (Knot* knot : {&k0, &k1}) {
      knot->v = Random(n, wildness, generator);
      knot->a = Random(n, wildness / gap, generator);
      knot->tau = VectorXd::Zero(robot.num_joints());
    }
    const VectorXd change = gap * (k0.v + k1.v) / 2 + Random(n, 0.1 * wildness * gap, generator);
    k1.q.tail(n - 3) += change.tail(n - 3);
    const Vector3d turn = change.head<3>();
    const Eigen::Quaterniond R =
        Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())) *
        Eigen::Quaterniond(k0.q[0], k0.q[1], k0.q[2], k0.q[3]);
    k1.q.head<4>() << R.w(), R.vec();
    const models::ContactPatch& patch = robot.contacts.front();
    for (int i = 0; i < static_cast<int>(patch.points.size()); ++i) {
      points.push_back({0, i, patch.link, patch.points[i]});
    }
    for (Knot* knot : {&k0, &k1}) {
      knot->forces.resize(3, static_cast<Eigen::Index>(points.size()));
      for (Eigen::Index i = 0; i < knot->forces.cols(); ++i) {
        knot->forces.col(i) = Random(3, 100, generator);
      }
    }
  }

  models::RobotModel robot;
  Knot k0, k1;
  std::vector<BearingPoint> points;
};

/// The residual at the motors and the root under the declared forces.
VectorXd Rest(const Motion& motion, const KnotInterpolant& interpolant, double t) {
  dynamics::TreeKinematics kinematics(motion.robot);
  const Knot knot = interpolant.At(t);
  kinematics.SetPosition(knot.q);
  kinematics.SetVelocity(knot.v);
  VectorXd rest = dynamics::NewtonEuler(kinematics, knot.a);
  for (int j = 0; j < motion.robot.num_joints(); ++j) {
    const models::Actuator& actuator = motion.robot.joints[j].actuator;
    rest[6 + j] += actuator.armature * knot.a[6 + j] + actuator.Friction(knot.v[6 + j]);
  }
  for (std::size_t i = 0; i < motion.points.size(); ++i) {
    kinematics.AddPointForce(motion.points[i].link, motion.points[i].p_L,
                             -knot.forces.col(static_cast<Eigen::Index>(i)), &rest);
  }
  return rest;
}

TEST(DerivativeBounds, HoldForTheForcesOfRandomMotions) {
  std::mt19937 generator(31);
  double tightest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double gap = std::pow(10, -3 + trial % 3);
    const Motion motion(gap, 0.1 * (1 + trial % 7), &generator);
    const KnotInterpolant interpolant(motion.k0, motion.k1);
    DerivativeBounds bounds(motion.robot);
    bounds.Set(interpolant, motion.k0, motion.k1, motion.points);
    const double h = 0.01 * gap;
    for (const double s : {0.02, 0.2, 0.5, 0.77, 0.98}) {
      const double t = s * gap;
      const VectorXd second = (Rest(motion, interpolant, t + h) - 2 * Rest(motion, interpolant, t) +
                               Rest(motion, interpolant, t - h)) /
                              (h * h);
      EXPECT_LE(second.head<3>().norm(), 1.001 * bounds.moment_change());
      EXPECT_LE(second.segment<3>(3).norm(), 1.001 * bounds.force_change());
      tightest = std::max(tightest, second.segment<3>(3).norm() / bounds.force_change());
      for (int j = 0; j < motion.robot.num_joints(); ++j) {
        EXPECT_LE(std::abs(second[6 + j]), 1.001 * bounds.JointTorqueChange(j))
            << motion.robot.joints[j].name;
      }
    }
  }
  // A bound that is far too large would pass as well.
  EXPECT_GT(tightest, 0.02);
}

TEST(DerivativeBounds, HoldForThePointsOfRandomMotions) {
  std::mt19937 generator(32);
  for (int trial = 0; trial < 60; ++trial) {
    const double gap = std::pow(10, -3 + trial % 3);
    const Motion motion(gap, 0.1 * (1 + trial % 7), &generator);
    const KnotInterpolant interpolant(motion.k0, motion.k1);
    DerivativeBounds bounds(motion.robot);
    bounds.Set(interpolant, motion.k0, motion.k1, motion.points);
    dynamics::TreeKinematics kinematics(motion.robot);
    const auto position = [&](double t, int link, const Vector3d& p_L) {
      kinematics.SetPosition(interpolant.At(t).q);
      return kinematics.Position(link, p_L);
    };
    const double h = 0.02 * gap;
    const double t = (0.1 + 0.8 * (trial % 11) / 10) * gap;
    for (int link = 0; link < motion.robot.num_links(); ++link) {
      const Vector3d p_L = Random(3, 0.2, &generator);
      std::array<Vector3d, 5> p;
      for (int i = 0; i < 5; ++i) p[i] = position(t + (i - 2) * h, link, p_L);
      const double radius = p_L.norm();
      // Rounding error of the quotients: 1e-15 m over h^k.
      const auto expect = [&](const Vector3d& quotient, int k) {
        EXPECT_LE(quotient.norm(), 1.01 * bounds.Point(link, radius, k) + 2e-14 / std::pow(h, k))
            << "derivative " << k << " of link " << link;
      };
      expect((p[3] - p[1]) / (2 * h), 1);
      expect((p[3] - 2 * p[2] + p[1]) / (h * h), 2);
      expect((p[4] - 2 * p[3] + 2 * p[1] - p[0]) / (2 * h * h * h), 3);
      expect((p[4] - 4 * p[3] + 6 * p[2] - 4 * p[1] + p[0]) / (h * h * h * h), 4);
    }
    for (const BearingPoint& point : motion.points) {
      const double radius = point.p_L.norm();
      EXPECT_GE(bounds.point_acceleration(), bounds.Point(point.link, radius, 2));
      EXPECT_GE(bounds.point_jerk(), bounds.Point(point.link, radius, 3));
    }
  }
}

/// One polynomial of degree 5.
struct Quintic {
  ControlPolygon<1, 6> polygon;

  double Front() const { return polygon.points[0]; }
  double Back() const { return polygon.points[5]; }
  double Bound() const { return polygon.points.maxCoeff(); }
  void Halve(Quintic* first, Quintic* second) const {
    polygon.Halve(&first->polygon, &second->polygon);
  }
  double At(double s) const {
    double sum = 0;
    const double binomials[] = {1, 5, 10, 10, 5, 1};
    for (int i = 0; i < 6; ++i) {
      sum += polygon.points[i] * binomials[i] * std::pow(s, i) * std::pow(1 - s, 5 - i);
    }
    return sum;
  }
};

TEST(BoundedMaximum, IsTheGreatestValueOfAPolynomial) {
  std::mt19937 generator(33);
  for (int trial = 0; trial < 100; ++trial) {
    Quintic quintic;
    quintic.polygon.points = Random(6, 1, &generator).transpose();
    double most = -1e9;
    for (int i = 0; i <= 2000; ++i) most = std::max(most, quintic.At(i / 2000.0));
    const Maximum maximum = BoundedMaximum<Quintic>(quintic, -1e9, 1e-10).best();
    EXPECT_GE(maximum.value, most - 1e-9);
    EXPECT_LE(maximum.value, most + 1e-4);
    EXPECT_NEAR(quintic.At(maximum.place), maximum.value, 1e-9);
    // The search stops where everything is small enough.
    const double enough = maximum.value + 1e-9;
    EXPECT_LE(BoundedMaximum<Quintic>(quintic, enough, 1e-10).best().value, enough);
  }
}

TEST(BoundedMaximum, IsTheBoundWhereHalvingNeverTightensIt) {
  struct Fog {
    double Front() const { return 0; }
    double Back() const { return 0; }
    double Bound() const { return 1; }
    void Halve(Fog* first, Fog* second) const { *first = *second = *this; }
  };
  EXPECT_EQ(BoundedMaximum<Fog>({}, 0.5, 1e-6).best().value, 1);
}

}  // namespace
}  // namespace possibility::actions
