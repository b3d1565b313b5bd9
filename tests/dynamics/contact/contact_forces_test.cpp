#include "dynamics/contact/contact_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "models/robot/robot_yaml.h"
#include "tests/dynamics/newton_euler.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// One rigid body of 10 kg, com at its origin, at the world origin.
models::RobotModel FreeBlock() {
  models::RobotModel model;
  model.links.resize(1);
  model.links[0].inertial.mass = 10;
  model.links[0].inertial.I_LC = Eigen::Matrix3d::Identity();
  return model;
}

/// FreeBlock with a massless limb on a joint about y.
models::RobotModel BlockWithLimb(double effort) {
  models::RobotModel model = FreeBlock();
  model.links.resize(2);
  models::Joint joint;
  joint.axis = Vector3d::UnitY();
  joint.effort = effort;
  model.joints.push_back(joint);
  return model;
}

VectorXd Identity(const models::RobotModel& model) { return VectorXd::Unit(model.nq(), 0); }

struct Standing {
  explicit Standing(const models::RobotModel& robot)
      : model(robot), kinematics(model), dynamics(MultibodyModel::Spatial(model)) {
    kinematics.SetPosition(Identity(model));
    kinematics.SetVelocity(VectorXd::Zero(model.nv()));
  }
  std::optional<ContactForces> Forces(const VectorXd& a, const std::vector<ContactPoint>& points) {
    dynamics.SetState(Identity(model), VectorXd::Zero(model.nv()), a);
    return DistributeContactForces(&dynamics, points, settings);
  }
  std::optional<ContactForces> Forces(const std::vector<ContactPoint>& points) {
    return Forces(VectorXd::Zero(model.nv()), points);
  }
  models::RobotModel model;
  TreeKinematics kinematics;
  MultibodyDynamics dynamics;
  ContactForceSettings settings;
};

std::vector<ContactPoint> Rectangle(int link, double x0, double x1, double y0, double y1,
                                    double z) {
  return {{link, {x0, y0, z}}, {link, {x1, y0, z}}, {link, {x1, y1, z}}, {link, {x0, y1, z}}};
}

/// The promises of DistributeContactForces, checked with inverse dynamics only.
void ExpectValid(TreeKinematics* kinematics, const VectorXd& a,
                 const std::vector<ContactPoint>& points, const ContactForceSettings& settings,
                 const ContactForces& result) {
  VectorXd residual = NewtonEuler(*kinematics, a);
  const double scale = 1 + residual.head<6>().norm() / 1000;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d f = result.forces.col(i);
    kinematics->AddPointForce(points[i].link, points[i].p_L, -f, &residual);
    const double reserve =
        settings.normal_reserve * (settings.shares.empty() ? 1 : settings.shares[i]);
    EXPECT_LE(f.head<2>().norm(),
              settings.friction * settings.friction_margin * (f.z() - reserve) + 1e-9);
    EXPECT_LE(f.head<2>().norm(), result.friction_utilisation * settings.friction * f.z() + 1e-9);
    EXPECT_GE(f.z(), reserve - 1e-9);
  }
  EXPECT_LT(residual.head<6>().norm(), 1e-9 * scale);
  EXPECT_LT((residual.tail(result.torques.size()) - result.torques).norm(), 1e-9 * scale);
  EXPECT_LE(result.friction_utilisation, settings.friction_margin);
  EXPECT_LE(result.torque_utilisation, settings.torque_margin);
  for (Eigen::Index i = 0; i < result.torques.size(); ++i) {
    EXPECT_LE(std::abs(result.torques[i]),
              settings.torque_margin * kinematics->model().joints[i].effort);
  }
}

TEST(ContactForces, FourCornersShareTheWeightEqually) {
  Standing block(FreeBlock());
  const auto result = block.Forces(Rectangle(0, -0.1, 0.1, -0.2, 0.2, -0.5));
  ASSERT_TRUE(result);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((result->forces.col(i) - Vector3d(0, 0, 10 * kGravity / 4)).norm(), 1e-9);
  }
  EXPECT_NEAR(result->friction_utilisation, 0, 1e-9);
}

TEST(ContactForces, TwoAndThreePointSupportsFollowTheLeverLaw) {
  Standing block(FreeBlock());
  for (const double x : {0.01, 0.1, 0.3}) {
    const auto beam = block.Forces({{0, {-0.1, 0, -0.5}}, {0, {x, 0, -0.5}}});
    ASSERT_TRUE(beam);
    EXPECT_NEAR(beam->forces(2, 0), 10 * kGravity * x / (x + 0.1), 1e-9);
    EXPECT_NEAR(beam->forces(2, 1), 10 * kGravity * 0.1 / (x + 0.1), 1e-9);
  }
  const auto tripod =
      block.Forces({{0, {-0.1, -0.1, -0.5}}, {0, {-0.1, 0.1, -0.5}}, {0, {0.3, 0, -0.5}}});
  ASSERT_TRUE(tripod);
  EXPECT_NEAR(tripod->forces(2, 2), 10 * kGravity * 0.25, 1e-9);
  EXPECT_NEAR(tripod->forces(2, 0), 10 * kGravity * 0.375, 1e-9);
  const auto one = block.Forces({{0, {0, 0, -0.5}}});
  ASSERT_TRUE(one);
  EXPECT_NEAR(one->forces(2, 0), 10 * kGravity, 1e-9);
}

// Pushed sideways, a block slips when the push exceeds the friction of its ground.
TEST(ContactForces, APointHasNoMoreFrictionThanItsGround) {
  Standing block(FreeBlock());
  block.settings.friction = 0.5;
  block.settings.friction_margin = 1;
  block.settings.cone_edges = 32;
  std::vector<ContactPoint> points = Rectangle(0, -0.5, 0.5, -0.5, 0.5, -1e-3);
  const auto push = [&](double acceleration) {
    return block.Forces(VectorXd::Unit(6, 3) * acceleration, points);
  };
  for (const double friction : {0.1, 0.3, 0.5, 7.0}) {
    for (ContactPoint& point : points) point.friction = friction;
    const double most = std::min(friction, 0.5) * kGravity;
    const auto result = push(0.97 * most);
    ASSERT_TRUE(result) << friction;
    EXPECT_NEAR(result->friction_utilisation, 0.97, 0.02);
    EXPECT_FALSE(push(1.01 * most)) << friction;
  }
}

TEST(ContactForces, EveryPointHasTheFrictionOfItsOwnGround) {
  Standing block(FreeBlock());
  block.settings.friction = 0.5;
  std::vector<ContactPoint> points = Rectangle(0, -0.5, 0.5, -0.5, 0.5, -1e-3);
  points[0].friction = 0.05;
  points[2].friction = 0.1;
  const auto result = block.Forces(VectorXd::Unit(6, 3) * 0.3 * kGravity, points);
  ASSERT_TRUE(result);
  for (int i = 0; i < 4; ++i) {
    const Vector3d f = result->forces.col(i);
    EXPECT_LE(f.head<2>().norm(), 0.9 * std::min(0.5, points[i].friction) * f.z() + 1e-9);
  }
  EXPECT_LE(result->friction_utilisation, 0.9);
  points[3].friction = 0;
  EXPECT_THROW(block.Forces(points), std::invalid_argument);
}

TEST(ContactForces, CoincidentPointsShareTheLoadEqually) {
  Standing block(FreeBlock());
  std::vector<ContactPoint> points = Rectangle(0, -0.1, 0.3, -0.1, 0.1, -0.5);
  points.push_back(points[0]);
  points.push_back(points[0]);
  const auto result = block.Forces(points);
  ASSERT_TRUE(result);
  EXPECT_LT((result->forces.col(0) - result->forces.col(4)).norm(), 1e-9);
  ExpectValid(&block.kinematics, VectorXd::Zero(6), points, block.settings, *result);
}

TEST(ContactForces, NoForcesExistIfTheCentreOfMassIsOutsideTheSupport) {
  Standing block(FreeBlock());
  EXPECT_FALSE(block.Forces(Rectangle(0, 0.001, 0.3, -0.1, 0.1, -0.5)));
  EXPECT_TRUE(block.Forces(Rectangle(0, -0.001, 0.3, -0.1, 0.1, -0.5)));
  EXPECT_FALSE(block.Forces({{0, {0.1, 0, -0.5}}, {0, {0.2, 0, -0.5}}}));
  EXPECT_FALSE(block.Forces({{0, {-0.1, 0.01, -0.5}}, {0, {0.2, 0.01, -0.5}}}));
  EXPECT_FALSE(block.Forces({{0, {0.01, 0, -0.5}}}));
}

TEST(ContactForces, ForcesExistExactlyWithinTheTippingAndSlidingLimits) {
  Standing block(FreeBlock());
  block.settings.friction = 0.5;
  block.settings.friction_margin = 1;
  const double half = 0.2;
  const double height = 0.5;
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    VectorXd a = VectorXd::Zero(6);
    a[3] = Uniform(&random, -6, 6);
    a[5] = Uniform(&random, -12, 6);
    const double normal = a[5] + kGravity;
    // The force passes through the com. The block tips beyond half / height and slides beyond the
    // octagon, whose side faces +x at cos(pi / 8) of the friction.
    const double bound = std::min(half / height, 0.5 * std::cos(M_PI / 8)) * normal;
    const double slack = bound - std::abs(a[3]);
    if (std::abs(slack) < 1e-6) continue;
    const std::vector<ContactPoint> points = Rectangle(0, -half, half, -0.1, 0.1, -height);
    const auto result = block.Forces(a, points);
    EXPECT_EQ(result.has_value(), slack > 0) << a.transpose();
    if (result) ExpectValid(&block.kinematics, a, points, block.settings, *result);
  }
}

TEST(ContactForces, TorqueLimitsBoundTheLoad) {
  // The only point bears the weight right under the com, 0.05 m in front of the joint.
  const double least = 0.05 * 10 * kGravity;
  for (const double ratio : {0.9, 0.999, 1.001, 2.0}) {
    models::RobotModel model = BlockWithLimb(ratio * least / 0.95);
    model.links[0].inertial.p_LC = Vector3d(0.1, 0, 0);
    model.joints[0].X_PJ.translation() = Vector3d(0.05, 0, 0);
    Standing robot(model);
    const auto result = robot.Forces({{1, {0.05, 0, -1}}});
    EXPECT_EQ(result.has_value(), ratio > 1);
    if (result) {
      EXPECT_NEAR(std::abs(result->torques[0]), least, 1e-9);
      EXPECT_NEAR(result->torque_utilisation, 0.95 / ratio, 1e-9);
    }
  }
}

TEST(ContactForces, TorqueLimitsOfUnloadedJointsHold) {
  // An arm that no contact holds. Its joint must bear the moment of its weight.
  for (const double effort : {1.0, 100.0}) {
    models::RobotModel model = BlockWithLimb(effort);
    model.links[1].inertial.mass = 1;
    model.links[1].inertial.p_LC = Vector3d(1, 0, 0);
    Standing robot(model);
    const auto result = robot.Forces(Rectangle(0, -0.5, 0.5, -0.5, 0.5, -0.5));
    EXPECT_EQ(result.has_value(), effort > kGravity / 0.95);
    if (result) {
      EXPECT_NEAR(std::abs(result->torques[0]), kGravity, 1e-9);
    }
  }
}

TEST(ContactForces, FreeFlightIsFeasibleOnlyAtGravitysAcceleration) {
  Standing robot(BlockWithLimb(1));
  VectorXd a = VectorXd::Zero(7);
  EXPECT_FALSE(robot.Forces(a, {}));
  a[5] = -kGravity;
  const auto result = robot.Forces(a, {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->forces.cols(), 0);
  EXPECT_NEAR(result->torques[0], 0, 1e-12);
}

TEST(ContactForces, NormalReserveHoldsAtEveryPoint) {
  Standing block(FreeBlock());
  const std::vector<ContactPoint> points = Rectangle(0, -0.02, 0.2, -0.1, 0.1, -0.5);
  block.settings.normal_reserve = 4;
  const auto result = block.Forces(points);
  ASSERT_TRUE(result);
  ExpectValid(&block.kinematics, VectorXd::Zero(6), points, block.settings, *result);
  block.settings.normal_reserve = 5;  // two front points already tip it
  EXPECT_FALSE(block.Forces(points));
}

/// Random trees pushed by random forces inside the cones. Such motions are feasible.
TEST(ContactForces, FindsForcesWhereverTheyExist) {
  std::mt19937 random(2);
  int limited = 0;
  for (int trial = 0; trial < 300; ++trial) {
    models::RobotModel model = RandomTree(&random, 8);
    TreeKinematics kinematics(model);
    const VectorXd q = RandomConfiguration(&random, model);
    const VectorXd v = RandomVector(&random, model.nv(), 1);
    kinematics.SetPosition(q);
    kinematics.SetVelocity(v);
    std::vector<ContactPoint> points;
    VectorXd loads = VectorXd::Zero(model.nv());
    ContactForceSettings settings;
    const double radius =
        settings.friction * settings.friction_margin * std::cos(M_PI / 8);  // of the octagon
    // Fewer points cannot take the rounding of the solved acceleration in every direction.
    const int count = 3 + static_cast<int>(random() % 6);
    for (int i = 0; i < count; ++i) {
      points.push_back(
          {static_cast<int>(random() % model.num_links()), RandomVector(&random, 3, 0.5)});
      const double normal = Uniform(&random, 0, 300);
      const double angle = Uniform(&random, 0, 2 * M_PI);
      const double tangential = normal * radius * Uniform(&random, 0, 0.999);
      const Vector3d force(tangential * std::cos(angle), tangential * std::sin(angle), normal);
      kinematics.AddPointForce(points.back().link, points.back().p_L, force, &loads);
    }
    // The root's acceleration results from those forces; the joints' is random.
    const int nv = model.nv();
    VectorXd a = RandomVector(&random, nv, 2);
    a.head<6>().setZero();
    const VectorXd bias = NewtonEuler(kinematics, a);
    Eigen::Matrix<double, 6, 6> M;
    for (int i = 0; i < 6; ++i) {
      M.col(i) = (NewtonEuler(kinematics, a + VectorXd::Unit(nv, i)) - bias).head<6>();
    }
    a.head<6>() = M.fullPivLu().solve((loads - bias).head<6>());
    const VectorXd torques = (NewtonEuler(kinematics, a) - loads).tail(model.num_joints());
    for (int i = 0; i < model.num_joints(); ++i) {
      model.joints[i].effort = (std::abs(torques[i]) + 1e-3) / settings.torque_margin;
    }
    MultibodyDynamics dynamics(MultibodyModel::Spatial(model));
    dynamics.SetState(q, v, a);
    const auto result = DistributeContactForces(&dynamics, points, settings);
    ASSERT_TRUE(result) << trial;
    ExpectValid(&kinematics, a, points, settings, *result);
    limited += result->torque_utilisation > 0.949999 || result->friction_utilisation > 0.83;
  }
  EXPECT_GT(limited, 50);
}

TEST(ContactForces, SharesDivideTheLoadOfPointsAtOnePlaceByTheirSquares) {
  Standing block(FreeBlock());
  block.settings.shares = {1, 0.5, 0.1, 1};
  const Vector3d below(0, 0, -0.5);
  const auto result = block.Forces({{0, below}, {0, below}, {0, below}, {0, below}});
  ASSERT_TRUE(result);
  const double unit = 10 * kGravity / 2.26;
  EXPECT_NEAR(result->forces(2, 0), unit, 1e-9);
  EXPECT_NEAR(result->forces(2, 1), 0.25 * unit, 1e-9);
  EXPECT_NEAR(result->forces(2, 2), 0.01 * unit, 1e-9);
  EXPECT_NEAR(result->forces(2, 3), unit, 1e-9);
}

TEST(ContactForces, APointOfSmallShareBearsWhatBalanceNeeds) {
  Standing block(FreeBlock());
  block.settings.shares = {1, 0.01};
  const auto result = block.Forces({{0, {-0.1, 0, -0.5}}, {0, {0.3, 0, -0.5}}});
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->forces(2, 1), 10 * kGravity * 0.25, 1e-9);
}

TEST(ContactForces, SharesDoNotChangeWhichMotionsAreFeasible) {
  std::mt19937 random(3);
  Standing block(FreeBlock());
  int feasible = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<ContactPoint> points;
    std::vector<double> shares;
    for (int i = 0; i < 5; ++i) {
      points.push_back({0, {Uniform(&random, -0.2, 0.2), Uniform(&random, -0.2, 0.2), -0.5}});
      shares.push_back(Uniform(&random, 0.05, 1));
    }
    const VectorXd a = RandomVector(&random, 6, 1);
    block.settings.shares.clear();
    const auto equal = block.Forces(a, points);
    block.settings.shares = shares;
    const auto shared = block.Forces(a, points);
    EXPECT_EQ(shared.has_value(), equal.has_value()) << trial;
    if (!shared) continue;
    ++feasible;
    block.kinematics.SetPosition(Identity(block.model));
    ExpectValid(&block.kinematics, a, points, block.settings, *shared);
  }
  EXPECT_GT(feasible, 50);
  EXPECT_LT(feasible, 250);
}

TEST(ContactForces, InvalidSharesAreRefused) {
  Standing block(FreeBlock());
  const std::vector<ContactPoint> points = Rectangle(0, -0.1, 0.1, -0.2, 0.2, -0.5);
  for (const double share : {0.0, -0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    block.settings.shares = {1, 1, share, 1};
    EXPECT_THROW(block.Forces(points), std::invalid_argument) << share;
  }
  block.settings.shares = {1, 1, 1};
  EXPECT_THROW(block.Forces(points), std::invalid_argument);
}

TEST(ContactForces, DrcHuboStandsOnBothFeetAndOnOne) {
  const models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  TreeKinematics kinematics(robot);
  const models::Gait& walk = robot.GaitNamed("walk");
  VectorXd q = robot.Configuration(walk.posture);
  kinematics.SetPosition(q);
  kinematics.SetVelocity(VectorXd::Zero(robot.nv()));
  const VectorXd a = VectorXd::Zero(robot.nv());
  MultibodyDynamics dynamics(MultibodyModel::Spatial(robot));
  dynamics.SetState(q, VectorXd::Zero(robot.nv()));
  std::vector<ContactPoint> both;
  for (const models::GaitLimb& limb : walk.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    std::vector<ContactPoint> one;
    for (const Vector3d& p : patch.points) one.push_back({patch.link, p});
    both.insert(both.end(), one.begin(), one.end());
    // The com is between the feet, so neither alone can hold it.
    EXPECT_FALSE(DistributeContactForces(&dynamics, one, {}));
  }
  const auto result = DistributeContactForces(&dynamics, both, {});
  ASSERT_TRUE(result);
  ExpectValid(&kinematics, a, both, {}, *result);
  EXPECT_NEAR(result->forces.row(2).sum(), robot.TotalMass() * kGravity, 1e-8);

  // One foot holds the robot while it accelerates sideways: the zero-moment point lies at
  // y - y'' * height / g.
  const models::ContactPatch& left = robot.contacts[walk.limbs[0].contact];
  std::vector<ContactPoint> one;
  for (const Vector3d& p : left.points) one.push_back({left.link, p});
  const Vector3d com = kinematics.CentreOfMass();
  VectorXd shifted = a;
  shifted[4] = -(kinematics.Position(left.link, left.Centre()).y() - com.y()) * kGravity / com.z();
  dynamics.SetAcceleration(shifted);
  const auto swayed = DistributeContactForces(&dynamics, one, {});
  ASSERT_TRUE(swayed);
  ExpectValid(&kinematics, shifted, one, {}, *swayed);
}

TEST(ContactForces, RefusesMalformedArguments) {
  Standing block(FreeBlock());
  EXPECT_THROW(block.Forces(VectorXd::Zero(5), {}), std::invalid_argument);
  EXPECT_THROW(block.Forces({{1, Vector3d::Zero()}}), std::invalid_argument);
  VectorXd a = VectorXd::Zero(6);
  a[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(block.Forces(a, {}), std::invalid_argument);
  block.settings.friction = -1;
  EXPECT_THROW(block.Forces({{0, Vector3d::Zero()}}), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
