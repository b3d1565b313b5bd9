// Rotors and friction against closed forms, and against rotors as bodies of their own.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "models/input/input_error.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/richardson.h"
#include "tests/dynamics/sagittal/random_symmetric_robot.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A box on which a mass slides up and down.
models::RobotModel LiftOnABox(const models::Actuator& actuator) {
  models::RobotModel robot;
  robot.links.resize(2);
  for (models::Link& link : robot.links) {
    link.inertial = {3, Vector3d::Zero(), 0.1 * Eigen::Matrix3d::Identity()};
  }
  robot.links[1].inertial.mass = 2;
  models::Joint slide;
  slide.name = "slide";
  slide.type = models::JointType::kPrismatic;
  slide.velocity = slide.effort = 100;
  slide.lower = -1;
  slide.upper = 1;
  slide.actuator = actuator;
  robot.joints.push_back(slide);
  return robot;
}

TEST(ActuatorsTest, AnImpactMovesTheLessTheGreaterTheArmature) {
  // The box stops. Momentum along the slide: (mass + armature) rate = - mass * speed.
  for (const double armature : {0.0, 0.5, 8.0}) {
    models::Actuator actuator;
    actuator.armature = armature;
    actuator.dry_friction = 30;  // bounded forces do nothing in no time
    ForwardDynamics dynamics(MultibodyModel::Spatial(LiftOnABox(actuator)));
    VectorXd q = VectorXd::Unit(8, 0), v = VectorXd::Zero(7);
    v[5] = -1.5;
    dynamics.SetState(q, v);
    const Impact impact =
        dynamics.Hit({{0, {0.1, 0.1, 0}}, {0, {-0.1, 0.1, 0}}, {0, {0, -0.1, 0}}});
    EXPECT_NEAR(impact.velocity[6], -2 * 1.5 / (2 + armature), 1e-9);
    const double before = 0.5 * 5 * 1.5 * 1.5;
    const double after = 0.5 * (2 + armature) * impact.velocity[6] * impact.velocity[6];
    EXPECT_NEAR(impact.energy_lost, before - after, 1e-9);
  }
}

TEST(ActuatorsTest, AHeldLiftAcceleratesByItsClosedForm) {
  const models::Actuator actuator{0.7, 1.5, 4, 0.2, {}};
  ForwardDynamics dynamics(MultibodyModel::Spatial(LiftOnABox(actuator)));
  std::vector<HeldPoint> held;
  for (const Vector3d& p : {Vector3d(0.1, 0.1, 0), Vector3d(-0.1, 0.1, 0), Vector3d(0, -0.1, 0)}) {
    held.push_back({{0, p}, p});
  }
  for (const double rate : {-2.0, -0.1, 0.0, 0.05, 1.0}) {
    VectorXd q = VectorXd::Unit(8, 0), v = VectorXd::Zero(7);
    v[6] = rate;
    dynamics.SetState(q, v);
    VectorXd forces = VectorXd::Zero(7);
    forces[6] = 25;
    const double expected =
        (25 - 2 * kGravity - 1.5 * rate - 4 * std::tanh(rate / 0.2)) / (2 + 0.7);
    EXPECT_NEAR(dynamics.Held(forces, held).acceleration[6], expected, 1e-8);
  }
}

/// The robot with a body for the rotor of each joint, which turns `ratio` times as fast about the
/// same axis.
models::RobotModel WithRotorBodies(models::RobotModel robot, double ratio) {
  const int joints = robot.num_joints();
  for (int i = 0; i < joints; ++i) {
    models::Joint rotor = robot.joints[i];
    const double inertia = rotor.actuator.armature / (ratio * ratio);
    rotor.actuator = robot.joints[i].actuator = {};
    rotor.type = models::JointType::kRevolute;
    rotor.mimic = models::Mimic{i, ratio, 0};
    robot.joints.push_back(rotor);
    robot.links.push_back(
        {"rotor", {0, Vector3d::Zero(), inertia * Eigen::Matrix3d::Identity()}, {}});
  }
  return robot;
}

TEST(ActuatorsTest, ArmaturesAreTheLimitOfRotorsThatTurnFast) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 10; ++trial) {
    models::RobotModel robot = RandomTree(&random, 1 + trial);
    for (models::Joint& joint : robot.joints) joint.actuator.armature = Uniform(&random, 0.1, 1);
    const auto model = MultibodyModel::Spatial(robot);
    MultibodyDynamics ours(model);
    double last = kInfinity;
    // What the rotor's carrier feels falls with the ratio: 100 times faster, 100 times less.
    for (const double ratio : {1e2, 1e4}) {
      MultibodyDynamics geared(MultibodyModel::Spatial(WithRotorBodies(robot, ratio)));
      const VectorXd q = RandomConfiguration(&random, robot);
      const VectorXd v = RandomVector(&random, robot.nv(), 3);
      const VectorXd a = RandomVector(&random, robot.nv(), 10);
      ours.SetState(q, v, a);
      geared.SetState(q, v, a);
      const double error = RelativeError(ours.InverseDynamics(), geared.InverseDynamics());
      EXPECT_LT(error, 5 / ratio);
      EXPECT_LT(RelativeError(ours.MassMatrix(), geared.MassMatrix()), 5 / ratio);
      EXPECT_LT(error, last);
      last = error;
    }
  }
}

TEST(ActuatorsTest, PowerGoesIntoEnergyAndFriction) {
  std::mt19937 random(6);
  const models::RobotModel robot = WithActuators(RandomTree(&random, 8), &random);
  const auto model = MultibodyModel::Spatial(robot);
  MultibodyDynamics dynamics(model);
  const auto energy = [&](const VectorXd& q, const VectorXd& v) {
    dynamics.SetState(q, v);
    const double potential =
        robot.TotalMass() * kGravity * dynamics.kinematics().CentreOfMass().z();
    return v.dot(dynamics.MassMatrix() * v) / 2 + potential;
  };
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd q = RandomConfiguration(&random, robot);
    const VectorXd v = RandomVector(&random, robot.nv(), 2);
    const VectorXd a = RandomVector(&random, robot.nv(), 5);
    constexpr double kStep = 1e-4;  // s
    const auto moved = [&](double t) {
      return energy(model->Displaced(q, t * v + t * t / 2 * a), v + t * a);
    };
    const double rate = (moved(kStep) - moved(-kStep)) / (2 * kStep);
    dynamics.SetState(q, v, a);
    double friction = 0;
    for (int j = 0; j < robot.num_joints(); ++j) {
      friction += v[6 + j] * robot.joints[j].actuator.Friction(v[6 + j]);
    }
    EXPECT_GE(friction, 0);
    EXPECT_NEAR(v.dot(dynamics.InverseDynamics()), rate + friction, 1e-4 * (1 + std::abs(rate)));
  }
}

TEST(ActuatorsTest, BothMotorsOfASagittalPairDriveTheLumpedJoint) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 10; ++trial) {
    models::RobotModel robot = WithActuators(RandomSymmetricRobot(&random), &random);
    for (models::Joint& joint : robot.joints) {
      joint.actuator.dry_speed = 0.7;  // WithActuators draws another one for each joint
      joint.actuator.line = models::TorqueSpeedLine{1.2 * joint.effort, 12};
    }
    const SagittalReduction reduction(robot);
    MultibodyDynamics planar(reduction.model());
    MultibodyDynamics full(MultibodyModel::Spatial(robot));
    const int nv = reduction.model()->nv();
    const VectorXd q = RandomVector(&random, nv, 1), v = RandomVector(&random, nv, 2),
                   a = RandomVector(&random, nv, 5);
    planar.SetState(q, v, a);
    full.SetState(reduction.ExpandConfiguration(q), reduction.ExpandVelocity(v),
                  reduction.ExpandVelocity(a));
    EXPECT_LT(
        RelativeError(planar.InverseDynamics(), reduction.ReduceForces(full.InverseDynamics())),
        1e-9);
    const VectorXd limits = reduction.ReduceForces(
        reduction.ExpandForces((VectorXd(nv) << 0, 0, 0, planar.torque_limits()).finished()));
    EXPECT_LT(RelativeError(limits.tail(nv - 3), planar.torque_limits()), 1e-12);
    const VectorXd each =
        reduction.ExpandForces((VectorXd(nv) << 0, 0, 0, planar.torque_limits()).finished());
    for (int j = 0; j < robot.num_joints(); ++j) {
      EXPECT_LE(std::abs(each[6 + j]), full.torque_limits()[j] * (1 + 1e-12));
    }
  }
}

TEST(ActuatorsTest, HalvesWithDifferentLinesAreNotLumped) {
  models::RobotModel robot = DrcHubo();
  robot.joints[robot.JointIndex("LKP")].actuator.line = models::TorqueSpeedLine{150, 20};
  EXPECT_NE(MessageOf<InputError>([&] {
              SagittalReduction reduction(robot);
            }).find("joints 'LKP' and 'RKP' differ in their torque-speed lines"),
            std::string::npos);
  robot.joints[robot.JointIndex("RKP")].actuator.line = models::TorqueSpeedLine{150, 20};
  robot.joints[robot.JointIndex("LKP")].actuator.dry_friction = 1;
  robot.joints[robot.JointIndex("RKP")].actuator.dry_friction = 2;
  robot.joints[robot.JointIndex("RKP")].actuator.dry_speed = 2;
  EXPECT_NE(MessageOf<InputError>([&] {
              SagittalReduction reduction(robot);
            }).find("joints 'LKP' and 'RKP' differ in their dry_speed"),
            std::string::npos);
}

}  // namespace
}  // namespace possibility::dynamics
