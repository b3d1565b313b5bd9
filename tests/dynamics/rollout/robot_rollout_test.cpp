#include "dynamics/rollout/robot_rollout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "dynamics/rollout/rollout_dynamics.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/rollout/box.h"
#include "tests/dynamics/rollout/compass_gait.h"
#include "tests/dynamics/rollout/walking_models.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

RobotRolloutSettings AccurateRollout(double tolerance) {
  RobotRolloutSettings settings;
  settings.hybrid.integration.method = OdeMethod::kAdams;
  settings.hybrid.integration.relative_tolerance = tolerance;
  settings.hybrid.integration.absolute_tolerance = tolerance;
  return settings;
}

const models::RobotModel& Drchubo1() {
  static const models::RobotModel robot = models::LoadRobotModel(
      std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "models/drchubo1/drchubo1.yaml");
  return robot;
}

std::vector<RolloutContact> Soles(const models::RobotModel& robot) {
  std::vector<RolloutContact> contacts;
  for (const char* name : {"left_sole", "right_sole"}) {
    const models::ContactPatch& patch = robot.contacts[robot.ContactIndex(name)];
    for (size_t i = 0; i < patch.points.size(); ++i) {
      contacts.push_back(ContactOn(patch.name + " " + std::to_string(i), patch.link,
                                   patch.points[i], Vector3d::UnitZ()));
      contacts.back().friction = robot.friction;
    }
  }
  return contacts;
}

std::vector<ContactPoint> PointsOf(const std::vector<RolloutContact>& contacts) {
  std::vector<ContactPoint> points;
  for (const RolloutContact& contact : contacts) points.push_back(contact.point);
  return points;
}

struct Conserved {
  double energy = 0;
  double magnitude = 0;  ///< J, sum of the terms whose difference is the energy
  Vector3d angular = Vector3d::Zero();
  Vector3d linear = Vector3d::Zero();
};

Conserved Measure(MultibodyDynamics* dynamics, const VectorXd& q, const VectorXd& v) {
  dynamics->SetState(q, v);
  const double kinetic = 0.5 * v.dot(dynamics->MassMatrix() * v);
  const double weight = dynamics->kinematics().total_mass() * kGravity;
  const double potential = weight * dynamics->kinematics().CentreOfMass().z();
  const VectorXd momentum = dynamics->Centroidal().momentum;
  return {kinetic + potential, kinetic + std::abs(potential), momentum.head<3>(),
          momentum.tail<3>()};
}

void ExpectFreeFlightConserves(const std::shared_ptr<const MultibodyModel>& model,
                               const VectorXd& q, const VectorXd& v) {
  RobotSimulator simulator(model, {}, {}, AccurateRollout(1e-11));
  const RobotRollout rollout = simulator.Run(q, v, 0, 5);
  ASSERT_EQ(rollout.end, RobotRolloutEnd::kTime);
  MultibodyDynamics dynamics(model);
  const Conserved start = Measure(&dynamics, q, v);
  const double weight = dynamics.kinematics().total_mass() * kGravity;
  for (double t = 0; t <= 5; t += 0.25) {
    const Conserved now = Measure(&dynamics, rollout.Configuration(t), rollout.Velocity(t));
    EXPECT_NEAR(now.energy, start.energy, 1e-7 * start.magnitude) << "t = " << t;
    EXPECT_LT((now.angular - start.angular).norm(), 1e-9 * (1 + start.angular.norm()))
        << "t = " << t;
    EXPECT_LT((now.linear - start.linear + Vector3d(0, 0, weight * t)).norm(),
              1e-9 * (1 + weight * t));
  }
}

TEST(RobotRollout, RandomTreesInFreeFlightConserveEnergyAndMomentum) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 4; ++trial) {
    const models::RobotModel tree = RandomTree(&random, 3 + trial);
    const auto model = MultibodyModel::Spatial(tree);
    VectorXd q = RandomVector(&random, model->nq(), 1);
    q.head<4>().normalize();
    ExpectFreeFlightConserves(model, q, RandomVector(&random, model->nv(), 1));
  }
}

TEST(RobotRollout, Drchubo1InFreeFlightConservesEnergyAndMomentum) {
  std::mt19937 random(4);
  const auto model = MultibodyModel::Spatial(Drchubo1());
  const VectorXd q = Drchubo1().Configuration(Drchubo1().GaitNamed("walk").posture);
  ExpectFreeFlightConserves(model, q, RandomVector(&random, model->nv(), 0.5));
}

TEST(RobotRollout, APushInFreeFlightAddsItsImpulse) {
  std::mt19937 random(6);
  const models::RobotModel tree = RandomTree(&random, 5);
  const auto model = MultibodyModel::Spatial(tree);
  VectorXd q = RandomVector(&random, model->nq(), 1);
  q.head<4>().normalize();
  const VectorXd v = RandomVector(&random, model->nv(), 1);
  const Vector3d force(30, -20, 10);
  RobotRolloutSettings settings = AccurateRollout(1e-11);
  settings.push = [force](double t) { return Vector3d(t < 0.5 ? t * force : (1 - t) * force); };
  RobotSimulator simulator(model, {}, {}, settings);
  const RobotRollout rollout = simulator.Run(q, v, 0, 1);
  MultibodyDynamics dynamics(model);
  const Conserved start = Measure(&dynamics, q, v);
  const Conserved end = Measure(&dynamics, rollout.q, rollout.v);
  const double weight = dynamics.kinematics().total_mass() * kGravity;
  EXPECT_LT((end.linear - start.linear + Vector3d(0, 0, weight) - 0.25 * force).norm(), 1e-7);
}

TEST(RobotRollout, APushOnASingleBodyActsAtItsCentreOfMass) {
  models::RobotModel body;
  body.links.resize(1);
  body.links[0].inertial.mass = 3;
  body.links[0].inertial.I_LC = Eigen::Matrix3d::Identity();
  body.links[0].inertial.p_LC = Vector3d(0.1, 0.2, 0.3);
  const auto model = MultibodyModel::Spatial(body);
  RobotRolloutSettings settings = AccurateRollout(1e-11);
  settings.push = [](double) { return Vector3d(6, 0, 0); };
  RobotSimulator simulator(model, {}, {}, settings);
  const RobotRollout rollout = simulator.Run(VectorXd::Unit(7, 0), VectorXd::Zero(6), 0, 1);
  EXPECT_LT(rollout.v.head<3>().norm(), 1e-9);
  EXPECT_NEAR(rollout.v[3], 2, 1e-9);
}

TEST(RobotRollout, StanceOfDrchubo1HoldsItsContacts) {
  const models::RobotModel& robot = Drchubo1();
  const auto model = MultibodyModel::Spatial(robot);
  const VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
  JointControl control;
  control.stiffness = VectorXd::Constant(model->num_joints(), 300);
  control.damping = VectorXd::Constant(model->num_joints(), 20);
  control.compensates_gravity = true;
  control.gravity_support = PointsOf(Soles(robot));
  const VectorXd posture = q.tail(model->num_joints());
  const int waist = robot.JointIndex("TSY"), shoulder = robot.JointIndex("LSP");
  control.command = [=](double t, JointCommand* command) {
    command->position = posture;
    command->position[waist] += 0.2 * std::sin(3 * t);
    command->position[shoulder] += 0.3 * (1 - std::cos(4 * t));
    command->torque[waist] = std::sin(5 * t);
  };
  RobotSimulator simulator(model, Soles(robot), control);
  const RobotRollout rollout = simulator.Run(q, VectorXd::Zero(model->nv()), 0, 2);
  EXPECT_EQ(rollout.end, RobotRolloutEnd::kTime) << rollout.reason;
  ASSERT_EQ(rollout.events.size(), 1);
  EXPECT_EQ(rollout.events[0].held.size(), 8);
  MultibodyDynamics dynamics(model);
  dynamics.SetState(q, VectorXd::Zero(model->nv()));
  std::vector<Vector3d> anchors;
  for (const RolloutContact& contact : Soles(robot)) {
    anchors.push_back(dynamics.Position(contact.point));
  }
  double moved = 0, drift = 0;
  for (double t = 0; t <= 2; t += 0.05) {
    const VectorXd now = rollout.Configuration(t);
    dynamics.SetState(now, rollout.Velocity(t));
    for (size_t i = 0; i < anchors.size(); ++i) {
      drift = std::max(drift, (dynamics.Position(Soles(robot)[i].point) - anchors[i]).norm());
    }
    moved = std::max(moved, (now.tail(model->num_joints()) - posture).lpNorm<Eigen::Infinity>());
    const RobotMotion motion = simulator.MotionAt(rollout, t);
    EXPECT_TRUE((motion.torques.cwiseAbs().array() <= model->effort().array()).all());
  }
  EXPECT_LT(drift, 1e-6);
  EXPECT_GT(moved, 0.2) << "the test must move the robot";
  EXPECT_GT(rollout.friction_utilisation.minCoeff(), 0);
  EXPECT_LT(rollout.friction_utilisation.maxCoeff(), 1);
}

/// A stance on both soles with feedback that is stiff for light links.
TEST(RobotRollout, DerivativesOfTheRateHoldItsStiffPart) {
  std::mt19937 random(11);
  const auto model = MultibodyModel::Spatial(Drchubo1());
  const int joints = model->num_joints();
  VectorXd state(model->nq() + model->nv());
  state << Drchubo1().Configuration(Drchubo1().GaitNamed("walk").posture),
      VectorXd::Zero(model->nv());
  JointControl control;
  control.stiffness = VectorXd::Constant(joints, 3000);
  control.damping = VectorXd::Constant(joints, 90);
  control.command = [posture = VectorXd(state.segment(7, joints))](double, JointCommand* command) {
    command->position = posture;
  };
  RolloutDynamics robot(model, Soles(Drchubo1()), control, {});
  robot.SetState(state);
  RolloutStance stance;
  for (int i = 0; i < robot.num_contacts(); ++i) stance.held.push_back(i);
  stance.points = robot.HeldWhereTheyAre(stance.held);
  const auto rate = [&](const VectorXd& at) {
    VectorXd result(at.size());
    result.tail(model->nv()) = robot.Accelerate(0, at, stance, nullptr);
    result.head(model->nq()) = model->ConfigurationRate(at.head(model->nq()), at.tail(model->nv()));
    return result;
  };
  Eigen::MatrixXd J(state.size(), state.size());
  robot.DifferentiateRate(0, state, stance, J);
  const double step = 1e-7;
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd direction = RandomVector(&random, static_cast<int>(state.size()), 1);
    // Only unit quaternions are configurations.
    direction.head<4>() -= direction.head<4>().dot(state.head<4>()) * state.head<4>();
    const VectorXd difference =
        (rate(state + step * direction) - rate(state - step * direction)) / (2 * step);
    EXPECT_LT((J * direction - difference).norm(), 0.01 * difference.norm());
  }
}

TEST(RobotRollout, ContactForcesAndTorquesExplainTheMotion) {
  const models::RobotModel& robot = Drchubo1();
  const auto model = MultibodyModel::Spatial(robot);
  const VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
  JointControl control;
  control.compensates_gravity = true;
  control.gravity_support = PointsOf(Soles(robot));
  RobotSimulator simulator(model, Soles(robot), control);
  const RobotRollout rollout = simulator.Run(q, VectorXd::Zero(model->nv()), 0, 0.1);
  const RobotMotion motion = simulator.MotionAt(rollout, 0.05);
  MultibodyDynamics dynamics(model);
  dynamics.SetState(motion.q, motion.v);
  dynamics.SetAcceleration(motion.a);
  VectorXd needed = dynamics.InverseDynamics();
  for (int i = 0; i < 8; ++i) {
    dynamics.AddPointForce(Soles(robot)[i].point, -motion.forces.col(i), needed);
  }
  needed.tail(model->num_joints()) -= motion.torques;
  EXPECT_LT(needed.lpNorm<Eigen::Infinity>(), 1e-8);
  // Gravity compensation alone keeps a balanced robot in place.
  EXPECT_LT(motion.v.lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_NEAR(motion.forces.row(2).sum(), robot.TotalMass() * kGravity, 1e-6);
}

TEST(RobotRollout, RimlessWheelAgreesWithItsClosedForm) {
  const double length = 0.6, inertia = 0.05, slope = 0.1, alpha = std::numbers::pi / 8;
  const auto model = RimlessWheel(inertia);
  const double about_foot = inertia + length * length;
  // The moment of momentum about the new foot gives the share of the rate that is kept.
  const double kept = (inertia + length * length * std::cos(2 * alpha)) / about_foot;
  const double gain = 4 * kGravity * length * std::sin(alpha) * std::sin(slope) / about_foot;
  RobotSimulator simulator(model, Spokes(8, length, slope), {}, AccurateRollout(1e-11));
  // Spoke 0 on the ground at the origin, as just after an impact.
  const double lean = slope - alpha;
  double square = 4;
  VectorXd q(3), v(3);
  q << lean, length * std::sin(lean), length * std::cos(lean);
  const double rate = std::sqrt(square);
  v << rate, rate * length * std::cos(lean), -rate * length * std::sin(lean);
  const RobotRollout rollout = simulator.Run(q, v, 0, 5);
  EXPECT_EQ(rollout.end, RobotRolloutEnd::kTime) << rollout.reason;
  int steps = 0;
  for (const RobotContactEvent& event : rollout.events) {
    ASSERT_EQ(event.held.size(), 1);
    if (event.time == 0) continue;
    ++steps;
    ASSERT_EQ(event.touched.size(), 1);
    EXPECT_EQ(event.held, event.touched);
    EXPECT_EQ(event.held[0], steps % 8);
    square = kept * kept * (square + gain);
    EXPECT_NEAR(event.v_after[0], std::sqrt(square), 1e-8);
    const double lost = 0.5 * about_foot * square * (1 / (kept * kept) - 1);
    EXPECT_NEAR(event.energy_lost, lost, 1e-8);
  }
  EXPECT_GT(steps, 8);
}

TEST(RobotRollout, CompassGaitAgreesWithLagrangesEquations) {
  CompassGait gait;
  gait.gravity = kGravity;
  HybridSettings reference;
  reference.integration.relative_tolerance = reference.integration.absolute_tolerance = 1e-12;
  const VectorXd start = CompassGait::NearLimitCycle();
  VectorXd consistent = start;  // both feet on the slope
  consistent[1] = 2 * gait.slope - consistent[0];
  const HybridRollout expected = RollOut(gait.Mode(), consistent, 0, 5, reference);

  const auto model = CompassTree(gait.leg_mass, gait.hip_mass, gait.mass_to_hip);
  std::vector<RolloutContact> feet;
  for (int leg = 0; leg < 2; ++leg) {
    feet.push_back(ContactOn("foot " + std::to_string(leg), leg, {0, 0, -gait.leg()},
                             SlopeNormal(gait.slope)));
    // Only steps in front of the other foot count; behind it the swing foot passes through the
    // ground.
    feet.back().lands = [leg](const VectorXd& q) { return (leg == 0 ? q[3] : -q[3]) > 0.1; };
  }
  RobotSimulator simulator(model, feet, {}, AccurateRollout(1e-12));
  // Leg 0 stands at the origin. The swing foot, on the slope too, is behind.
  const double lean = consistent[0], rate = consistent[2];
  VectorXd q(4), v(4);
  q << lean, gait.leg() * std::sin(lean), gait.leg() * std::cos(lean), consistent[1] - lean;
  v << rate, rate * gait.leg() * std::cos(lean), -rate * gait.leg() * std::sin(lean),
      consistent[3] - rate;
  const RobotRollout rollout = simulator.Run(q, v, 0, 5);
  EXPECT_EQ(rollout.end, RobotRolloutEnd::kTime) << rollout.reason;
  std::vector<RobotContactEvent> touchdowns;
  for (const RobotContactEvent& event : rollout.events) {
    if (event.time > 0) touchdowns.push_back(event);
  }
  ASSERT_GT(expected.events.size(), 5);
  ASSERT_EQ(touchdowns.size(), expected.events.size());
  for (size_t i = 0; i < touchdowns.size(); ++i) {
    EXPECT_NEAR(touchdowns[i].time, expected.events[i].time, 1e-8) << "step " << i;
    const int stance = (i + 1) % 2;
    EXPECT_EQ(touchdowns[i].held, std::vector<int>{stance});
    const VectorXd& after = touchdowns[i].v_after;
    const double rates[2] = {after[0], after[0] + after[3]};
    EXPECT_NEAR(rates[stance], expected.events[i].after[2], 1e-7);
    EXPECT_NEAR(rates[1 - stance], expected.events[i].after[3], 1e-7);
  }
}

TEST(RobotRollout, BoxDroppedFlatLandsInOneImpact) {
  const auto model = MultibodyModel::Spatial(Box());
  RobotSimulator simulator(model, Corners(Vector3d::UnitZ()), {}, AccurateRollout(1e-11));
  const RobotRollout rollout = simulator.Run(BoxAt(0.6), VectorXd::Zero(6), 0, 1);
  ASSERT_EQ(rollout.events.size(), 1);
  const double fall = std::sqrt(2 * 0.5 / kGravity);
  EXPECT_NEAR(rollout.events[0].time, fall, 1e-8);
  EXPECT_EQ(rollout.events[0].held.size(), 4);
  EXPECT_NEAR(rollout.events[0].energy_lost, 0.5 * kGravity, 1e-7);
  EXPECT_NEAR(rollout.events[0].impulses.row(2).sum(), fall * kGravity, 1e-7);
  EXPECT_LT(rollout.v.norm(), 1e-9);
  EXPECT_NEAR(rollout.q[6], 0.1, 1e-9);
}

TEST(RobotRollout, BoxDroppedOnACornerComesToRest) {
  const auto model = MultibodyModel::Spatial(Box());
  RobotRolloutSettings settings = AccurateRollout(1e-9);
  settings.rest_energy = 1e-6;
  RobotSimulator simulator(model, Corners(Vector3d::UnitZ()), {}, settings);
  const RobotRollout rollout = simulator.Run(BoxAt(0.3, 0.1, 0.15), VectorXd::Zero(6), 0, 5);
  EXPECT_EQ(rollout.end, RobotRolloutEnd::kAtRest) << rollout.reason;
  EXPECT_NEAR(rollout.q[6], 0.1, 1e-6);
  EXPECT_NEAR(std::abs(rollout.q[0]), std::cos(std::asin(rollout.q[3])), 1e-5) << "upright";
  double lost = 0;
  for (const RobotContactEvent& event : rollout.events) {
    EXPECT_GE(event.energy_lost, 0);
    lost += event.energy_lost;
  }
  EXPECT_NEAR(lost, kGravity * 0.2, 1e-6) << rollout.events.size() << " events";
}

/// Ground of which somebody says that it is everywhere is no other ground.
TEST(RobotRollout, BoxComesToRestOnALevelThatItAsksFor) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> tilt(-0.02, 0.02);
  const auto model = MultibodyModel::Spatial(Box());
  std::vector<RolloutContact> asking = Corners(Vector3d::UnitZ());
  for (RolloutContact& corner : asking) corner.lands = [](const VectorXd&) { return true; };
  RobotRolloutSettings settings = AccurateRollout(1e-9);
  settings.hybrid.end_at_zeno = true;
  settings.hybrid.zeno_events = 1000;
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd start = BoxAt(0.1 + 0.008 + 0.0005 * trial, tilt(random), tilt(random));
    RobotSimulator simulator(model, asking, {}, settings);
    const RobotRollout rollout = simulator.Run(start, VectorXd::Zero(6), 0, 1.5);
    EXPECT_NEAR(rollout.q[6], 0.1, 1e-6) << "trial " << trial;
    EXPECT_LT(rollout.v.norm(), 1e-4) << "trial " << trial;
  }
}

TEST(RobotRollout, BoxOnASlopeStaysSlipsOrTips) {
  // Friction 0.7: the box slips above atan 0.7 = 35 degrees and tips above atan 2 = 63 degrees.
  const auto model = MultibodyModel::Spatial(Box());
  const auto run = [&](double degrees, bool ends_at_slip) {
    const double slope = degrees * std::numbers::pi / 180;
    const Vector3d normal = SlopeNormal(slope);
    RobotRolloutSettings settings = AccurateRollout(1e-9);
    settings.ends_at_slip = ends_at_slip;
    RobotSimulator simulator(model, Corners(normal), {}, settings);
    VectorXd q = BoxAt(0, 0, slope);
    q.tail<3>() = 0.1 * normal;
    return simulator.Run(q, VectorXd::Zero(6), 0, 0.2);
  };
  const RobotRollout stays = run(30, true);
  EXPECT_EQ(stays.end, RobotRolloutEnd::kTime) << stays.reason;
  EXPECT_LT(stays.v.norm(), 1e-9);
  EXPECT_NEAR(stays.friction_utilisation[0], std::tan(std::numbers::pi / 6) / 0.7, 1e-6);
  const RobotRollout slips = run(40, true);
  EXPECT_EQ(slips.end, RobotRolloutEnd::kSlip);
  EXPECT_EQ(slips.time, 0);
  EXPECT_NE(slips.reason.find("slips"), std::string::npos);
  EXPECT_GT(run(40, false).friction_utilisation[0], 1);
  const RobotRollout tips = run(70, false);
  ASSERT_FALSE(tips.events.empty());
  EXPECT_EQ(tips.events[0].held, (std::vector<int>{2, 3})) << "the lower edge bears";
  EXPECT_GT(tips.v[1], 0.1) << "it turns downhill";
}

/// A box with a slider of the same mass on an arm, which keeps its speed of 0.2 m/s. Their common
/// centre is over the box's edge when the slider is at 0.4 m.
RobotRollout SlideBeyondTheEdge(double start, double duration) {
  models::RobotModel robot = Box();
  robot.links.push_back(LinkOf("slider", 1, Vector3d::Zero(), 1e-3));
  models::Joint joint;
  joint.name = "slide";
  joint.type = models::JointType::kPrismatic;
  joint.axis = Vector3d::UnitX();
  joint.lower = -2;
  joint.upper = 2;
  joint.velocity = 10;
  joint.effort = 1000;
  robot.joints.push_back(joint);
  const auto model = MultibodyModel::Spatial(robot);
  VectorXd q = VectorXd::Zero(8), v = VectorXd::Zero(7);
  q.head<7>() = BoxAt(0.1);
  q[7] = start;
  v[6] = 0.2;
  RobotSimulator simulator(model, Corners(Vector3d::UnitZ()), {}, AccurateRollout(1e-11));
  return simulator.Run(q, v, 0, duration);
}

TEST(RobotRollout, PushedBoxTipsAboutItsEdgeWhenTheMomentReachesZero) {
  const RobotRollout rollout = SlideBeyondTheEdge(0, 2.5);
  ASSERT_GE(rollout.events.size(), 2);
  EXPECT_NEAR(rollout.events[1].time, 2, 1e-8);
  EXPECT_EQ(rollout.events[1].held, (std::vector<int>{2, 3}));
  EXPECT_EQ(rollout.events[1].released, (std::vector<int>{0, 1}));
  EXPECT_GT(rollout.v[1], 0.1);
}

/// So little beyond that the points behind are selected as bearing. They must not stick.
TEST(RobotRollout, BoxWhoseWeightIsBeyondItsEdgeByARoundingErrorTipsAtOnce) {
  for (const double beyond : {1e-12, 1e-10, 1e-8, 1e-7}) {
    const RobotRollout rollout = SlideBeyondTheEdge(0.4 + beyond, 0.5);
    ASSERT_GE(rollout.events.size(), 1);
    EXPECT_LT(rollout.events.back().time, 1e-3);
    EXPECT_EQ(rollout.events.back().held, (std::vector<int>{2, 3}));
    EXPECT_GT(rollout.v[1], 0.1);
  }
}

TEST(RobotRollout, ABallInAGrooveRestsOnBothPlanes) {
  // A ball dropped into a groove of two planes touches one, then the other, and rests in it.
  const auto model = MultibodyModel::Spatial(Box());
  std::vector<RolloutContact> contacts;
  for (const double side : {-1.0, 1.0}) {
    contacts.push_back(ContactOn("centre", 0, Vector3d::Zero(), SlopeNormal(side * 0.6)));
  }
  RobotRolloutSettings settings = AccurateRollout(1e-10);
  RobotSimulator simulator(model, contacts, {}, settings);
  VectorXd q = BoxAt(0.5);
  const RobotRollout rollout = simulator.Run(q, VectorXd::Zero(6), 0, 1);
  EXPECT_NEAR(rollout.q[6], 0, 1e-8);
  EXPECT_EQ(rollout.events.back().held, (std::vector<int>{0, 1}));
}

/// Painleve's rod: its tip is at rest on the ground and would sink slowly, but it turns so fast
/// that it would have to be pulled down to stay where it is.
RobotRollout RolloutOfARod(bool gets_up, double jam_depth) {
  models::RobotModel rod;
  rod.name = "rod";
  rod.links = {LinkOf("rod", 1, Vector3d::Zero(), 0.05)};
  const double lean = 0.9, sinks_at = 0.5;
  const double rate = std::sqrt((kGravity - sinks_at) / std::cos(lean));
  VectorXd q(7), v(6);
  q << std::cos(lean / 2), 0, std::sin(lean / 2), 0, 0, 0, std::cos(lean);
  const Vector3d turning(0, gets_up ? -rate : rate, 0);
  const Vector3d tip(-std::sin(lean), 0, -std::cos(lean));
  v << turning, -turning.cross(tip);
  RobotRolloutSettings settings = AccurateRollout(1e-10);
  settings.jam_depth = jam_depth;
  RobotSimulator simulator(MultibodyModel::Spatial(rod),
                           {ContactOn("tip", 0, -Vector3d::UnitZ(), Vector3d::UnitZ())}, {},
                           settings);
  return simulator.Run(q, v, 0, 0.08);
}

double HeightOfTip(const RobotRollout& rollout, double t) {
  const VectorXd q = rollout.Configuration(t);
  return q[6] - (Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Vector3d::UnitZ()).z();
}

TEST(RobotRollout, AJammedPointIsHeldAtOnceUnlessItMaySink) {
  const RobotRollout held = RolloutOfARod(true, 0);
  ASSERT_FALSE(held.events.empty());
  EXPECT_EQ(held.events[0].time, 0);
  EXPECT_EQ(held.events[0].jammed, std::vector<int>{0});
}

TEST(RobotRollout, AJamThatPassesIsNotHeld) {
  const RobotRollout free = RolloutOfARod(true, 1e-3);
  ASSERT_EQ(free.events.size(), 1u);
  EXPECT_TRUE(free.events[0].held.empty());
  double lowest = 0;
  for (int i = 0; i <= 80; ++i) lowest = std::min(lowest, HeightOfTip(free, i * 1e-3));
  EXPECT_LT(lowest, -1e-5);
  EXPECT_GT(lowest, -1e-3);
  EXPECT_GT(HeightOfTip(free, 0.08), 0) << "the tip rises again";
}

TEST(RobotRollout, AJamThatLastsIsHeldOnceThePointHasSunk) {
  const RobotRollout sunk = RolloutOfARod(false, 1e-3);
  ASSERT_GE(sunk.events.size(), 2u);
  EXPECT_TRUE(sunk.events[0].held.empty());
  EXPECT_GT(sunk.events[1].time, 0.03);
  EXPECT_EQ(sunk.events[1].touched, std::vector<int>{0});
  EXPECT_NEAR(HeightOfTip(sunk, sunk.events[1].time), -1e-3, 1e-6);
}

TEST(RobotRollout, TorquesNeverExceedTheLimits) {
  const models::RobotModel& robot = Drchubo1();
  const auto model = MultibodyModel::Spatial(robot);
  VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
  q[6] += 0.5;
  JointControl control;
  control.stiffness = VectorXd::Constant(model->num_joints(), 5000);
  control.damping = VectorXd::Constant(model->num_joints(), 50);
  RobotSimulator simulator(model, {}, control);
  const RobotRollout rollout = simulator.Run(q, VectorXd::Zero(model->nv()), 0, 0.2);
  EXPECT_EQ(rollout.torque_utilisation.maxCoeff(), 1) << "the test must reach a limit";
  for (double t = 0; t <= 0.2; t += 0.001) {
    const VectorXd torques = simulator.MotionAt(rollout, t).torques;
    EXPECT_TRUE((torques.cwiseAbs().array() <= model->effort().array()).all());
  }
}

TEST(RobotRollout, TheSameStartGivesTheSameResult) {
  const auto model = MultibodyModel::Spatial(Box());
  RobotSimulator one(model, Corners(Vector3d::UnitZ()), {}),
      other(model, Corners(Vector3d::UnitZ()), {});
  const VectorXd q = BoxAt(0.3, 0.1, 0.15), v = VectorXd::Zero(6);
  const RobotRollout first = one.Run(q, v, 0, 1), second = other.Run(q, v, 0, 1);
  const RobotRollout third = one.Run(q, v, 0, 1);
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.v, third.v);
  EXPECT_EQ(first.events.size(), third.events.size());
}

TEST(RobotRollout, CancellationEndsTheRollout) {
  const auto model = MultibodyModel::Spatial(Box());
  RobotRolloutSettings settings;
  int asked = 0;
  settings.hybrid.integration.cancellation = CancellationToken([&asked] { return ++asked <= 5; });
  RobotSimulator simulator(model, {}, {}, settings);
  EXPECT_EQ(simulator.Run(BoxAt(1), VectorXd::Zero(6), 0, 100).end, RobotRolloutEnd::kCancelled);
}

TEST(RobotRollout, InvalidArgumentsAreRefused) {
  const auto model = MultibodyModel::Spatial(Box());
  const VectorXd q = BoxAt(1), v = VectorXd::Zero(6);
  EXPECT_THROW(RobotSimulator(nullptr, {}, {}), std::invalid_argument);
  const auto rejected = [&](auto change) {
    std::vector<RolloutContact> contacts = Corners(Vector3d::UnitZ());
    change(contacts[0]);
    EXPECT_THROW(RobotSimulator(model, contacts, {}), std::invalid_argument);
  };
  rejected([](RolloutContact& c) { c.point.link = 1; });
  rejected([](RolloutContact& c) { c.point.link = -1; });
  rejected([](RolloutContact& c) { c.point.p_L[0] = NAN; });
  rejected([](RolloutContact& c) { c.point.normal_W *= 2; });
  rejected([](RolloutContact& c) { c.offset = INFINITY; });
  rejected([](RolloutContact& c) { c.friction = -1; });
  RobotSimulator simulator(model, Corners(Vector3d::UnitZ()), {});
  EXPECT_THROW(simulator.Run(q.head(6), v, 0, 1), std::invalid_argument);
  EXPECT_THROW(simulator.Run(q, VectorXd::Constant(6, NAN), 0, 1), std::invalid_argument);
  EXPECT_THROW(simulator.Run(BoxAt(0), v, 0, 1), std::invalid_argument) << "in the ground";
  JointControl control;
  control.stiffness = VectorXd::Ones(3);
  EXPECT_THROW(RobotSimulator(model, {}, control), std::invalid_argument);
  const auto robot = MultibodyModel::Spatial(Drchubo1());
  control.stiffness.resize(0);
  control.command = [](double t, JointCommand* command) {
    if (t > 0.05) command->torque[0] = NAN;
  };
  RobotSimulator commanded(robot, {}, control);
  const VectorXd stance = Drchubo1().Configuration(Drchubo1().GaitNamed("walk").posture);
  EXPECT_THROW(commanded.Run(stance, VectorXd::Zero(robot->nv()), 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
