#include "dynamics/contact/contact_feasibility.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// The factor that a pyramid of 32 edges loses at most.
const double kPyramid = 1 / std::cos(M_PI / 32);

models::RobotModel Block() {
  models::RobotModel model;
  model.links.resize(1);
  model.links[0].name = "block";
  model.links[0].inertial.mass = 10;
  model.links[0].inertial.I_LC = Eigen::Matrix3d::Identity();
  return model;
}

/// A planar block with two limbs on hinges at (-0.3, 0) and (0.3, 0), without mass, 0.5 long.
models::RobotModel Biped(double effort) {
  models::RobotModel model = Block();
  for (const double x : {-0.3, 0.3}) {
    models::Joint joint;
    joint.name = x < 0 ? "rear" : "front";
    joint.axis = Vector3d::UnitY();
    joint.X_PJ.translation() = Vector3d(x, 0, 0);
    joint.effort = effort;
    model.joints.push_back(joint);
    model.links.push_back({joint.name, {}, {}});
  }
  return model;
}

ContactForceSettings Fine() {
  ContactForceSettings settings;
  settings.friction = 0.8;
  settings.friction_margin = 1;
  settings.torque_margin = 1;
  settings.cone_edges = 32;
  return settings;
}

Vector3d Inclined(double angle) { return {-std::sin(angle), 0, std::cos(angle)}; }

TEST(ContactMargins, BlockOnASlopeNeedsTheTangentOfItsInclination) {
  MultibodyDynamics block(MultibodyModel::Spatial(Block()));
  for (const double angle : {0.0, 0.1, 0.4, -0.6}) {
    // The block stands upright on steps of the slope under its com, so that all points bear alike.
    std::vector<ContactPoint> points;
    for (const double y : {-0.1, 0.1}) {
      points.push_back({0, {0.1, y, -0.5}, Inclined(angle)});
      points.push_back({0, {-0.1, y, -0.5}, Inclined(angle)});
    }
    block.SetState(VectorXd::Unit(7, 0), VectorXd::Zero(6));
    const auto margins = ComputeContactMargins(&block, points, Fine());
    ASSERT_TRUE(margins);
    const double least = std::abs(std::tan(angle)) / 0.8;
    EXPECT_GE(margins->friction_fraction, least - 1e-9);
    EXPECT_LE(margins->friction_fraction, least * kPyramid + 2 * kMarginPrecision);
    EXPECT_EQ(margins->effort_fraction, 0);
  }
  const std::vector<ContactPoint> steep = {{0, {0, 0, -0.5}, Inclined(0.7)}};
  EXPECT_FALSE(ComputeContactMargins(&block, steep, Fine()));
}

TEST(ContactMargins, AGrooveHoldsWithoutFriction) {
  MultibodyDynamics block(MultibodyModel::Spatial(Block()));
  block.SetState(VectorXd::Unit(7, 0), VectorXd::Zero(6));
  std::vector<ContactPoint> points;
  for (const double y : {-0.2, 0.2}) {
    points.push_back({0, {0.3, y, -0.3}, Inclined(M_PI / 4)});
    points.push_back({0, {-0.3, y, -0.3}, Inclined(-M_PI / 4)});
  }
  const auto margins = ComputeContactMargins(&block, points, Fine());
  ASSERT_TRUE(margins);
  EXPECT_LT(margins->friction_fraction, 2 * kMarginPrecision);
  // This holds at zero friction, too.
  ContactForceSettings smooth = Fine();
  smooth.friction = 0;
  EXPECT_TRUE(ComputeContactMargins(&block, points, smooth));
}

/// Two points in the plane. One internal force s is free; a scan over it gives both margins.
struct Scan {
  double friction = kInfinity;
  double effort = kInfinity;
};

Scan ScanInternalForce(MultibodyDynamics* dynamics, const std::vector<ContactPoint>& points,
                       const ContactForceSettings& settings) {
  const VectorXd required = dynamics->InverseDynamics();
  MatrixXd J(6, 5);
  for (int i = 0; i < 2; ++i) dynamics->Jacobian(points[i], J.middleRows<3>(3 * i));
  // Forces (x, z) at both points.
  MatrixXd loads(5, 4);
  loads << J.row(0).transpose(), J.row(2).transpose(), J.row(3).transpose(), J.row(5).transpose();
  const MatrixXd base = loads.topRows<3>();
  const VectorXd particular = base.completeOrthogonalDecomposition().solve(required.head(3));
  const VectorXd null = base.fullPivLu().kernel().col(0).normalized();
  Scan scan;
  const double range = 400;
  for (double s = -range; s <= range; s += 0.005) {
    const VectorXd f = particular + s * null;
    double friction = 0;
    for (int i = 0; i < 2; ++i) {
      const Vector3d force(f[2 * i], 0, f[2 * i + 1]);
      const double along = force.dot(points[i].normal_W);
      friction = along > 0 ? std::max(friction, FrictionUsed(points[i], force)) : kInfinity;
      if (along <= 0) break;
    }
    const double effort = (required - loads * f).tail(2).cwiseAbs().maxCoeff() /
                          dynamics->model().effort().maxCoeff();
    if (effort <= settings.torque_margin) {
      scan.friction = std::min(scan.friction, friction / settings.friction);
    }
    if (friction <= settings.friction * settings.friction_margin) {
      scan.effort = std::min(scan.effort, effort);
    }
  }
  return scan;
}

TEST(ContactMargins, AgreeWithAScanOfTheInternalForce) {
  std::mt19937 random(1);
  int compared = 0;
  for (int trial = 0; trial < 25; ++trial) {
    MultibodyDynamics biped(MultibodyModel::Planar(Biped(60)));
    VectorXd q = RandomVector(&random, 5, 0.5);
    q.head<3>().setZero();
    VectorXd a = VectorXd::Zero(5);
    for (const int i : {1, 2}) a[i] = Uniform(&random, -2, 2);
    biped.SetState(q, VectorXd::Zero(5), a);
    std::vector<ContactPoint> points;
    for (const int link : {1, 2}) {
      points.push_back({link, {0, 0, -0.5}, Inclined(Uniform(&random, -0.4, 0.4))});
    }
    ContactForceSettings settings = Fine();
    settings.torque_margin = 0.9;
    const Scan scan = ScanInternalForce(&biped, points, settings);
    const auto margins = ComputeContactMargins(&biped, points, settings);
    if (!margins) {
      // Only what the pyramid loses may be refused.
      settings.friction /= kPyramid * 1.0001;
      EXPECT_FALSE(std::isfinite(ScanInternalForce(&biped, points, settings).friction) &&
                   ScanInternalForce(&biped, points, settings).friction < 1);
      continue;
    }
    ++compared;
    EXPECT_GT(margins->friction_fraction, scan.friction - 5e-4);
    EXPECT_LT(margins->friction_fraction, scan.friction * kPyramid + 5e-4);
    EXPECT_GT(margins->effort_fraction, scan.effort - 5e-4);
    settings.friction /= kPyramid;
    EXPECT_LT(margins->effort_fraction, ScanInternalForce(&biped, points, settings).effort + 5e-4);
  }
  EXPECT_GT(compared, 10);
}

TEST(ContactMargins, ScaleWithFrictionAndEfforts) {
  std::mt19937 random(2);
  const models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  models::RobotModel strong = robot;
  for (models::Joint& joint : strong.joints) joint.effort *= 2;
  std::vector<ContactPoint> points;
  for (const char* name : {"left_sole", "right_sole"}) {
    const models::ContactPatch& patch = robot.contacts[robot.ContactIndex(name)];
    for (const Vector3d& p : patch.points) points.push_back({patch.link, p});
  }
  MultibodyDynamics dynamics(MultibodyModel::Spatial(robot));
  MultibodyDynamics stronger(MultibodyModel::Spatial(strong));
  for (int trial = 0; trial < 3; ++trial) {
    VectorXd a = VectorXd::Zero(robot.nv());
    a.segment<3>(3) = RandomVector(&random, 3, 0.5);
    const VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
    dynamics.SetState(q, VectorXd::Zero(robot.nv()), a);
    stronger.SetState(q, VectorXd::Zero(robot.nv()), a);
    ContactForceSettings settings = Fine();
    const auto margins = ComputeContactMargins(&dynamics, points, settings);
    ASSERT_TRUE(margins);
    const auto forces = DistributeContactForces(&dynamics, points, settings);
    EXPECT_LE(margins->friction_fraction, forces->friction_utilisation);
    EXPECT_LE(margins->effort_fraction, forces->torque_utilisation);
    EXPECT_GT(margins->effort_fraction, 0.01);
    // At the margins the motion is still possible, a little below them no more.
    for (const double factor : {0.99, 1.01}) {
      ContactForceSettings at = settings;
      at.torque_margin = factor * margins->effort_fraction;
      EXPECT_EQ(DistributeContactForces(&dynamics, points, at).has_value(), factor > 1);
      at = settings;
      at.friction_margin = factor * margins->friction_fraction + 1e-5 * (factor - 1);
      EXPECT_EQ(DistributeContactForces(&dynamics, points, at).has_value(), factor > 1);
    }
    const auto with_motors = ComputeContactMargins(&stronger, points, settings);
    ASSERT_TRUE(with_motors);
    EXPECT_NEAR(with_motors->effort_fraction, margins->effort_fraction / 2, 1e-5);
    settings.friction *= 2;
    const auto with_friction = ComputeContactMargins(&dynamics, points, settings);
    ASSERT_TRUE(with_friction);
    EXPECT_NEAR(with_friction->friction_fraction, margins->friction_fraction / 2, 1e-5);
  }
}

TEST(ContactMargins, ForcesAreInIndependentCoordinates) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    models::RobotModel model = RandomTree(&random, 8);
    for (models::Joint& joint : model.joints) joint.effort = 1e6;
    model.joints[4].mimic = models::Mimic{1, -0.7, 0.2};
    MultibodyDynamics dynamics(MultibodyModel::Spatial(model));
    const int nv = dynamics.model().nv();
    VectorXd q = RandomVector(&random, dynamics.model().nq(), 1);
    q.head<4>().normalize();
    dynamics.SetState(q, RandomVector(&random, nv, 1));
    std::vector<ContactPoint> points;
    for (int i = 0; i < 40; ++i) {
      const Vector3d normal = RandomVector(&random, 3, 1).normalized();
      points.push_back({static_cast<int>(random() % 9), RandomVector(&random, 3, 1), normal});
    }
    const auto result = DistributeContactForces(&dynamics, points, Fine());
    ASSERT_TRUE(result);
    ASSERT_EQ(result->torques.size(), 7);
    VectorXd left = dynamics.InverseDynamics();
    for (std::size_t i = 0; i < points.size(); ++i) {
      dynamics.AddPointForce(points[i], -result->forces.col(i), left);
      const double along = result->forces.col(i).dot(points[i].normal_W);
      EXPECT_GE(along, -1e-9);
      EXPECT_LE((result->forces.col(i) - along * points[i].normal_W).norm(), 0.8 * along + 1e-9);
    }
    EXPECT_LT(left.head<6>().norm(), 1e-7);
    EXPECT_LT((left.tail(7) - result->torques).norm(), 1e-7);
  }
}

/// A box of 10 kg that lands flat, its com `height` above the ground, with corners at +-half.
struct LandingCase {
  ImpulseFeasibility Check(const Vector3d& velocity, double friction) {
    ForwardDynamics dynamics(MultibodyModel::Spatial(Block()));
    VectorXd v = VectorXd::Zero(6);
    v.tail<3>() = velocity;
    dynamics.SetState(VectorXd::Unit(7, 0), v);
    points.clear();
    for (const double x : {-half, half}) {
      for (const double y : {-half, half}) points.push_back({0, {x, y, -height}});
    }
    const Impact& impact = dynamics.Hit(points);
    EXPECT_LT(impact.velocity.norm(), 1e-9);
    return CheckImpact(&dynamics, impact, points, friction);
  }
  double half = 0.2;
  double height = 0.5;
  std::vector<ContactPoint> points;
};

TEST(ImpulseFeasibility, LandingBoxSticksSlipsOrTips) {
  LandingCase landing;
  std::mt19937 random(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Vector3d velocity(Uniform(&random, -1.5, 1.5), 0, -2);
    const double friction = Uniform(&random, 0.1, 0.8);
    // The impulse m (-vx, 0, -vz) must pass through the com: its line meets the ground at
    // height * vx / vz off the middle.
    const double ratio = std::abs(velocity.x() / velocity.z());
    if (std::abs(ratio * landing.height - landing.half) < 1e-3) continue;
    const ImpulseFeasibility result = landing.Check(velocity, friction);
    if (ratio * landing.height < landing.half) {
      EXPECT_GE(result.friction_fraction, ratio / friction - 1e-9);
      EXPECT_LE(result.friction_fraction, ratio / friction * kPyramid + 1e-5);
      EXPECT_EQ(result.feasible, result.friction_fraction <= 1);
      EXPECT_FALSE(result.pulling_point);
    } else {
      EXPECT_FALSE(result.feasible);
      EXPECT_EQ(result.friction_fraction, kInfinity);
      ASSERT_TRUE(result.pulling_point);
      // The corners at the trailing edge are the ones that would have to pull.
      EXPECT_LT(landing.points[*result.pulling_point].p_L.x() * velocity.x(), 0);
    }
    EXPECT_LT((result.impulses.rowwise().sum() + 10 * velocity).norm(), 1e-7);
  }
}

TEST(ImpulseFeasibility, AnotherDistributionNeedNotPull) {
  // Nearly all of the weight is over one end of a row of points. The impulses of least norm are
  // linear in the position and pull at the other end. The two nearest points alone do not pull.
  models::RobotModel model = Block();
  model.links[0].inertial.p_LC = Vector3d(0.45, 0, 0);
  ForwardDynamics dynamics(MultibodyModel::Planar(model));
  std::vector<ContactPoint> points;
  for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) points.push_back({0, {x, 0, -0.1}});
  dynamics.SetState(VectorXd::Zero(3), Vector3d(0, 0, -1));
  const Impact& impact = dynamics.Hit(points);
  EXPECT_LT(impact.impulses(2, 0), -0.1);
  const ImpulseFeasibility result = CheckImpact(&dynamics, impact, points, 0.7);
  EXPECT_TRUE(result.feasible);
  EXPECT_GE(result.impulses.row(2).minCoeff(), -1e-9);
  MatrixXd J(3, 3);
  VectorXd change = VectorXd::Zero(3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics.dynamics()->Jacobian(points[i], J);
    change += J.transpose() * (result.impulses.col(i) - impact.impulses.col(i));
  }
  EXPECT_LT(change.norm(), 1e-8);
}

TEST(ImpulseFeasibility, FramesTurnTogether) {
  // Everything is turned by one rotation. The fractions stay the same but for the pyramids' sides.
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const int count = 2 + static_cast<int>(random() % 4);
    const Eigen::Matrix3d R = RandomPose(&random, 0).linear();
    MatrixXd J(3 * count, 6);
    MatrixXd turned(3 * count, 6);
    Eigen::Matrix3Xd impulses(3, count);
    std::vector<ContactPoint> points(count);
    std::vector<ContactPoint> turned_points(count);
    for (int i = 0; i < count; ++i) {
      J.middleRows<3>(3 * i) = RandomVector(&random, 18, 1).reshaped(3, 6);
      turned.middleRows<3>(3 * i) = R * J.middleRows<3>(3 * i);
      impulses.col(i) = RandomVector(&random, 3, 1) + Vector3d(0, 0, 1.5);
      turned_points[i].normal_W = R.col(2);
    }
    const auto upright = CheckImpulses(J, impulses, points, 0.7);
    const auto slanted = CheckImpulses(turned, R * impulses, turned_points, 0.7);
    if (std::isinf(upright.friction_fraction) || std::isinf(slanted.friction_fraction)) continue;
    EXPECT_LT(upright.friction_fraction, slanted.friction_fraction * kPyramid + 1e-4);
    EXPECT_LT(slanted.friction_fraction, upright.friction_fraction * kPyramid + 1e-4);
  }
}

TEST(ContactFeasibility, RefusesMalformedArgumentsByName) {
  const auto mentions = [](const std::function<void()>& call, const std::string& word) {
    return MessageOf(call).find(word) != std::string::npos;
  };
  MultibodyDynamics block(MultibodyModel::Spatial(Block()));
  block.SetState(VectorXd::Unit(7, 0), VectorXd::Zero(6));
  const ContactPoint good;
  const auto margins = [&](const ContactPoint& point, const ContactForceSettings& settings) {
    return [&block, point, settings] { ComputeContactMargins(&block, {{}, point}, settings); };
  };
  EXPECT_TRUE(mentions(margins({2, Vector3d::Zero()}, {}), "point 1 is on link 2"));
  EXPECT_TRUE(mentions(margins({0, Vector3d(0, NAN, 0)}, {}), "point 1 has a position"));
  EXPECT_TRUE(mentions(margins({0, Vector3d::Zero(), Vector3d(0, 0, 2)}, {}), "normal"));
  EXPECT_TRUE(mentions(margins({0, Vector3d::Zero(), Vector3d(0, 0, NAN)}, {}), "normal"));
  ContactForceSettings settings;
  settings.cone_edges = 2;
  EXPECT_TRUE(mentions(margins(good, settings), "cone_edges"));
  settings = {};
  settings.friction = -1;
  EXPECT_TRUE(mentions(margins(good, settings), "settings"));

  const MatrixXd J = MatrixXd::Identity(3, 6);
  const Eigen::Matrix3Xd impulse = Eigen::Matrix3Xd::Ones(3, 1);
  EXPECT_TRUE(mentions([&] { CheckImpulses(J, impulse, {good}, -0.1); }, "friction"));
  EXPECT_TRUE(mentions([&] { CheckImpulses(J, impulse, {good}, NAN); }, "friction"));
  EXPECT_TRUE(mentions([&] { CheckImpulses(J, impulse, {good, good}, 1); }, "2 points"));
  EXPECT_TRUE(mentions([&] { CheckImpulses(J * NAN, impulse, {good}, 1); }, "jacobian"));
  EXPECT_TRUE(mentions([&] { CheckImpulses(J, impulse * NAN, {good}, 1); }, "impulses"));
  EXPECT_TRUE(CheckImpulses(MatrixXd(0, 6), Eigen::Matrix3Xd(3, 0), {}, 1).feasible);
}

}  // namespace
}  // namespace possibility::dynamics
