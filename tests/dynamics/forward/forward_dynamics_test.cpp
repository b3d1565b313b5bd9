#include "dynamics/forward/forward_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "dynamics/simbody/simbody_dynamics.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<ContactPoint> PatchPoints(const models::RobotModel& robot,
                                      const std::vector<std::string>& contacts) {
  std::vector<ContactPoint> points;
  for (const std::string& name : contacts) {
    const models::ContactPatch& patch = robot.contacts[robot.ContactIndex(name)];
    for (const Vector3d& p : patch.points) points.push_back({patch.link, p});
  }
  return points;
}

std::vector<ContactPoint> RandomPoints(const models::RobotModel& model, int count,
                                       std::mt19937* random) {
  std::vector<ContactPoint> points;
  for (int i = 0; i < count; ++i) {
    const int link = static_cast<int>((*random)() % model.num_links());
    points.push_back({link, RandomVector(random, 3, 0.3)});
  }
  return points;
}

/// Points held where they are.
std::vector<HeldPoint> Hold(ForwardDynamics* dynamics, const std::vector<ContactPoint>& points) {
  std::vector<HeldPoint> held;
  for (const ContactPoint& point : points) {
    held.push_back({point, dynamics->dynamics()->Position(point)});
  }
  return held;
}

MatrixXd Jacobians(ForwardDynamics* dynamics, const std::vector<ContactPoint>& points) {
  MatrixXd J(3 * points.size(), dynamics->model().nv());
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics->dynamics()->Jacobian(points[i], J.middleRows<3>(3 * i));
  }
  return J;
}

VectorXd Stacked(const Eigen::Matrix3Xd& forces) {
  return Eigen::Map<const VectorXd>(forces.data(), forces.size());
}

void ExpectInverse(const std::shared_ptr<const MultibodyModel>& model, int states,
                   std::mt19937* random) {
  ForwardDynamics forward(model);
  MultibodyDynamics inverse(model);
  for (int state = 0; state < states; ++state) {
    VectorXd q = RandomVector(random, model->nq(), 2);
    if (model->base() == Base::kFloating) q.head<4>().normalize();
    const VectorXd v = RandomVector(random, model->nv(), 3);
    const VectorXd a = RandomVector(random, model->nv(), 20);
    inverse.SetState(q, v, a);
    forward.SetState(q, v);
    EXPECT_LT((forward.Free(inverse.InverseDynamics()) - a).norm(), 1e-10 * a.norm());
  }
}

TEST(ForwardDynamics, UndoesInverseDynamics) {
  std::mt19937 random(1);
  ExpectInverse(MultibodyModel::Spatial(DrcHubo()), 300, &random);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model = RandomTree(&random, static_cast<int>(random() % 25));
    ExpectInverse(MultibodyModel::Spatial(model), 10, &random);
  }
}

TEST(ForwardDynamics, UndoesInverseDynamicsWithCoupledJoints) {
  std::mt19937 random(2);
  for (int tree = 0; tree < 20; ++tree) {
    models::RobotModel model = RandomTree(&random, 12);
    // Masters are on other branches and further out, so the mass matrix has entries off the
    // branches.
    for (const int joint : {2, 7, 9}) {
      const int master = joint == 7 ? 11 : static_cast<int>(random() % 2);
      model.joints[joint].mimic = models::Mimic{master, Uniform(&random, 0.5, 2), 0.1};
    }
    ExpectInverse(MultibodyModel::Spatial(model), 10, &random);
  }
}

/// The expected values come from Simbody's own matrices, by a dense factorisation of the system.
TEST(ForwardDynamics, HeldAndHitAgreeWithSimbodysMatrices) {
  std::mt19937 random(3);
  const models::RobotModel drc = DrcHubo();
  for (int trial = 0; trial < 40; ++trial) {
    const bool is_drc = trial % 2 == 0;
    const models::RobotModel model = is_drc ? drc : RandomTree(&random, 12);
    const int nv = model.nv();
    ForwardDynamics dynamics(MultibodyModel::Spatial(model), {kInfinity});
    SimbodyDynamics simbody(model);
    const VectorXd q = RandomConfiguration(&random, model);
    const VectorXd v = RandomVector(&random, nv, 2);
    const VectorXd forces = RandomVector(&random, nv, 100);
    dynamics.SetState(q, v);
    simbody.SetState(q, v);
    const std::vector<ContactPoint> points = RandomPoints(model, 2, &random);

    const MatrixXd M = simbody.MassMatrix();
    const VectorXd bias = simbody.InverseDynamics(VectorXd::Zero(nv));
    MatrixXd system = MatrixXd::Zero(nv + 6, nv + 6);
    VectorXd right(nv + 6);
    VectorXd hit_right = VectorXd::Zero(nv + 6);
    system.topLeftCorner(nv, nv) = M;
    right.head(nv) = forces - bias;
    hit_right.head(nv) = M * v;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Matrix3Xd J = simbody.PointJacobian(points[i].link, points[i].p_L);
      system.block(nv + 3 * i, 0, 3, nv) = J;
      system.block(0, nv + 3 * i, nv, 3) = -J.transpose();
      right.segment<3>(nv + 3 * i) = -simbody.PointBias(points[i].link, points[i].p_L);
    }
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(system);
    // Links that hang on few joints cannot follow, so not every random pair can be held.
    if (factors.rank() < nv + 6) continue;
    const VectorXd expected = factors.solve(right);
    const ConstrainedMotion& motion = dynamics.Held(forces, Hold(&dynamics, points));
    EXPECT_LT((motion.acceleration - expected.head(nv)).norm(), 1e-7 * (1 + expected.norm()));
    EXPECT_LT((Stacked(motion.forces) - expected.tail<6>()).norm(), 1e-7 * (1 + expected.norm()));

    const SimbodyDynamics::HeldMotion theirs = simbody.ForwardDynamics(forces, points);
    EXPECT_LT((motion.acceleration - theirs.acceleration).norm(), 1e-7 * (1 + expected.norm()));
    EXPECT_LT((motion.forces - theirs.forces).norm(), 1e-7 * (1 + expected.norm()));
    EXPECT_LT((dynamics.Free(forces) - simbody.ForwardDynamics(forces)).norm(),
              1e-9 * (1 + expected.norm()));

    const VectorXd after = factors.solve(hit_right);
    const Impact& impact = dynamics.Hit(points);
    EXPECT_LT((impact.velocity - after.head(nv)).norm(), 1e-8 * (1 + after.norm()));
    EXPECT_LT((Stacked(impact.impulses) - after.tail<6>()).norm(), 1e-7 * (1 + after.norm()));
    const double lost = 0.5 * v.dot(M * v) - 0.5 * after.head(nv).dot(M * after.head(nv));
    EXPECT_NEAR(impact.energy_lost, lost, 1e-9 * v.dot(M * v));
    EXPECT_GE(impact.energy_lost, 0);
  }
}

TEST(ForwardDynamics, BothSolesOfDrcHuboHoldWithLeastForces) {
  std::mt19937 random(4);
  const models::RobotModel robot = DrcHubo();
  ForwardDynamics dynamics(MultibodyModel::Spatial(robot));
  const std::vector<ContactPoint> points = PatchPoints(robot, {"left_sole", "right_sole"});
  for (int trial = 0; trial < 50; ++trial) {
    VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
    q.tail(robot.num_joints()) += RandomVector(&random, robot.num_joints(), 0.2);
    const VectorXd forces = RandomVector(&random, robot.nv(), 100);
    dynamics.SetState(q, VectorXd::Zero(robot.nv()));
    const ConstrainedMotion& motion = dynamics.Held(forces, Hold(&dynamics, points));
    const MatrixXd J = Jacobians(&dynamics, points);
    EXPECT_LT((J * motion.acceleration).norm(), 1e-8 * motion.acceleration.norm());
    dynamics.dynamics()->SetAcceleration(motion.acceleration);
    const VectorXd loads = J.transpose() * Stacked(motion.forces);
    EXPECT_LT((dynamics.dynamics()->InverseDynamics() - forces - loads).norm(),
              1e-9 * (1 + loads.norm()));
    // The smallest forces with the same effect: the pseudo-inverse's.
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(J.transpose());
    EXPECT_EQ(factors.rank(), 12);
    EXPECT_LT((factors.solve(loads) - Stacked(motion.forces)).norm(),
              1e-6 * (1 + motion.forces.norm()));
  }
}

TEST(ForwardDynamics, ResponseIsTheDerivativeOfTheHeldMotion) {
  std::mt19937 random(8);
  const models::RobotModel robot = DrcHubo();
  ForwardDynamics dynamics(MultibodyModel::Spatial(robot));
  const double rate = 1 / dynamics.settings().drift_time;
  for (const auto& names : {std::vector<std::string>{"left_sole", "right_sole"},
                            std::vector<std::string>{"right_sole"}, std::vector<std::string>{}}) {
    const std::vector<ContactPoint> points = PatchPoints(robot, names);
    VectorXd q = robot.Configuration(robot.GaitNamed("walk").posture);
    q.tail(robot.num_joints()) += RandomVector(&random, robot.num_joints(), 0.2);
    const VectorXd forces = RandomVector(&random, robot.nv(), 100);
    dynamics.SetState(q, VectorXd::Zero(robot.nv()));
    const std::vector<HeldPoint> held = Hold(&dynamics, points);
    const MatrixXd J = Jacobians(&dynamics, points);
    const VectorXd before = dynamics.Held(forces, held).acceleration;
    const ConstrainedResponse response = dynamics.Response();
    // The motion is linear in forces and in the drift that the anchors see.
    for (int trial = 0; trial < 10; ++trial) {
      const VectorXd change = RandomVector(&random, robot.nv(), 100);
      const VectorXd answer = dynamics.Held(forces + change, held).acceleration - before;
      EXPECT_LT((response.to_forces * change - answer).norm(), 1e-5 * answer.norm());
      const VectorXd moved = RandomVector(&random, robot.nv(), 0.01);
      std::vector<HeldPoint> drifted = held;
      for (std::size_t i = 0; i < held.size(); ++i) {
        drifted[i].anchor -= J.middleRows<3>(3 * i) * moved;
      }
      const VectorXd feedback = dynamics.Held(forces, drifted).acceleration - before;
      EXPECT_LT((feedback + rate * rate * response.to_drift * moved).norm(),
                1e-5 * (1e-3 + feedback.norm()));
    }
  }
}

TEST(ForwardDynamics, CoincidentPointsShareForcesAndCollinearOnesAddNothing) {
  std::mt19937 random(5);
  const models::RobotModel model = RandomTree(&random, 8);
  ForwardDynamics dynamics(MultibodyModel::Spatial(model));
  dynamics.SetState(RandomConfiguration(&random, model), VectorXd::Zero(model.nv()));
  const VectorXd forces = RandomVector(&random, model.nv(), 50);
  const Vector3d p(0.1, 0.2, 0.3);
  const Vector3d d(0.05, -0.1, 0.02);
  const ContactPoint one{0, p};
  const VectorXd alone = dynamics.Held(forces, Hold(&dynamics, {one})).acceleration;
  const Vector3d force = dynamics.Held(forces, Hold(&dynamics, {one})).forces.col(0);
  const ConstrainedMotion twice = dynamics.Held(forces, Hold(&dynamics, {one, one}));
  EXPECT_LT((twice.acceleration - alone).norm(), 1e-8 * alone.norm());
  EXPECT_LT((twice.forces.col(0) - force / 2).norm(), 1e-6 * force.norm());
  EXPECT_LT((twice.forces.col(1) - force / 2).norm(), 1e-6 * force.norm());

  const std::vector<ContactPoint> ends = {{0, p}, {0, p + 3 * d}};
  const std::vector<ContactPoint> line = {{0, p}, {0, p + d}, {0, p + 2 * d}, {0, p + 3 * d}};
  const VectorXd with_ends = dynamics.Held(forces, Hold(&dynamics, ends)).acceleration;
  const VectorXd with_line = dynamics.Held(forces, Hold(&dynamics, line)).acceleration;
  EXPECT_LT((with_ends - with_line).norm(), 1e-8 * with_ends.norm());
}

/// A rigid sole that has turned since it was held: its points ask for feedback that no rigid motion
/// gives, by half the angle.
TEST(ForwardDynamics, SolesThatHaveTurnedAreStillHeld) {
  const auto model = MultibodyModel::Spatial(DrcHubo());
  const std::vector<ContactPoint> points = PatchPoints(model->tree(), {"left_sole", "right_sole"});
  ForwardDynamics dynamics(model);
  std::mt19937 random(5);
  VectorXd q = VectorXd::Zero(model->nq());
  q[0] = 1;
  for (const char* knee : {"LKP", "RKP"}) q[7 + model->tree().JointIndex(knee)] = 1;
  const VectorXd rest = VectorXd::Zero(model->nv());
  const double rate = 1 / dynamics.settings().drift_time;
  for (int trial = 0; trial < 50; ++trial) {
    dynamics.SetState(q, rest);
    const std::vector<HeldPoint> held = Hold(&dynamics, points);
    VectorXd turn = VectorXd::Zero(model->nv());
    turn.head<3>() = RandomVector(&random, 3, 1).normalized() * 1e-3;
    dynamics.SetState(model->Displaced(q, turn), rest);
    const VectorXd a = dynamics.Held(rest, held).acceleration;
    const VectorXd given = Jacobians(&dynamics, points) * a;
    double asked = 0, missing = 0;
    for (std::size_t i = 0; i < held.size(); ++i) {
      const Vector3d drift = dynamics.dynamics()->Position(points[i]) - held[i].anchor;
      asked = std::max(asked, rate * rate * drift.norm());
      missing = std::max(missing, (given.segment<3>(3 * i) + rate * rate * drift).norm());
    }
    EXPECT_LT(missing, 1e-3 * asked) << trial;
  }
}

/// The drift of a held point decays as (1 + t / T) exp(-t / T) times its displacement.
TEST(ForwardDynamics, DriftIsFedBackCriticallyDamped) {
  std::mt19937 random(6);
  const models::RobotModel model = RandomTree(&random, 6);
  const double time = 0.05;
  ForwardDynamics dynamics(MultibodyModel::Spatial(model), {time});
  for (int trial = 0; trial < 10; ++trial) {
    const VectorXd v = RandomVector(&random, model.nv(), 1);
    dynamics.SetState(RandomConfiguration(&random, model), v);
    const ContactPoint point{3, Vector3d(0.1, 0, 0.2)};
    const Vector3d off = RandomVector(&random, 3, 0.01);
    const HeldPoint held{point, dynamics.dynamics()->Position(point) - off};
    const VectorXd a = dynamics.Held(VectorXd::Zero(model.nv()), {held}).acceleration;
    dynamics.dynamics()->SetAcceleration(a);
    const Vector3d expected =
        -2 / time * dynamics.dynamics()->Velocity(point) - off / (time * time);
    EXPECT_LT((dynamics.dynamics()->Acceleration(point) - expected).norm(),
              1e-7 * (1 + expected.norm()));
  }
}

models::RobotModel Body(double mass, const Vector3d& moments) {
  models::RobotModel model;
  model.links.resize(1);
  model.links[0].name = "body";
  model.links[0].inertial.mass = mass;
  model.links[0].inertial.I_LC = moments.asDiagonal();
  return model;
}

TEST(ForwardDynamics, FallingRodHitsWithItsEnd) {
  // The rod is inclined by theta and falls without turning. After the impact it turns at 3 u
  // cos(theta) / (2 L). The vertical impulse is m u (1 - 3/4 cos^2(theta)), and sticking adds a
  // horizontal one.
  const double mass = 2;
  const double length = 1.2;
  const double u = 3;
  const double moment = mass * length * length / 12;
  ForwardDynamics dynamics(MultibodyModel::Planar(Body(mass, {moment, moment, moment})));
  for (const double theta : {0.0, 0.3, 0.9, 1.5}) {
    dynamics.SetState(Vector3d(theta, 0, 1), Vector3d(0, 0, -u));
    // The link's x axis points along (cos, 0, -sin) of the pitch, so its end is the lower one.
    const Impact& impact = dynamics.Hit({{0, {length / 2, 0, 0}}});
    const double rate = 3 * u * std::cos(theta) / (2 * length);
    EXPECT_NEAR(impact.velocity[0], -rate, 1e-9);
    EXPECT_NEAR(impact.impulses(2, 0), mass * u * (1 - 0.75 * std::pow(std::cos(theta), 2)), 1e-9);
    EXPECT_NEAR(impact.impulses(0, 0), -mass * length / 2 * std::sin(theta) * rate, 1e-9);
    EXPECT_EQ(impact.impulses(1, 0), 0);
    // Angular momentum about the end is kept: m u L/2 cos(theta) = m L^2 / 3 rate.
    const double after = 0.5 * (mass * length * length / 3) * rate * rate;
    EXPECT_NEAR(impact.energy_lost, 0.5 * mass * u * u - after, 1e-9);
  }
}

TEST(ForwardDynamics, BoxLandingOnOneEdgeRocksOver) {
  // Like a rimless wheel of one spoke: the box keeps its angular momentum about the edge.
  const double mass = 5;
  const Vector3d half(0.2, 0.3, 0.1);
  const Vector3d squares = half.array().square();
  const Vector3d moments =
      mass / 3 *
      Vector3d(squares.y() + squares.z(), squares.z() + squares.x(), squares.x() + squares.y());
  ForwardDynamics dynamics(MultibodyModel::Spatial(Body(mass, moments)));
  VectorXd q = VectorXd::Unit(7, 0);
  VectorXd v = VectorXd::Zero(6);
  v[1] = 0.7;
  v[3] = 0.4;
  v[5] = -2;
  dynamics.SetState(q, v);
  const std::vector<ContactPoint> edge = {{0, {half.x(), half.y(), -half.z()}},
                                          {0, {half.x(), -half.y(), -half.z()}}};
  const Impact& impact = dynamics.Hit(edge);
  // About the edge (+y): H = I w + m (r x u) with r from the edge to the com.
  const Vector3d r(-half.x(), 0, half.z());
  const double before = moments.y() * v[1] + mass * r.cross(Vector3d(v[3], 0, v[5])).y();
  const double rate = before / (moments.y() + mass * (squares.x() + squares.z()));
  const Vector3d com = rate * Vector3d::UnitY().cross(r);
  EXPECT_NEAR(impact.velocity[1], rate, 1e-12);
  EXPECT_LT((impact.velocity.tail<3>() - com).norm(), 1e-12);
  EXPECT_LT((impact.impulses.col(0) - impact.impulses.col(1)).norm(), 1e-8);
  EXPECT_LT((impact.impulses.rowwise().sum() - mass * (com - Vector3d(v.tail<3>()))).norm(), 1e-9);
}

TEST(ForwardDynamics, ImpactsBalanceMomentum) {
  std::mt19937 random(7);
  const models::RobotModel robot = DrcHubo();
  ForwardDynamics dynamics(MultibodyModel::Spatial(robot));
  const std::vector<ContactPoint> points =
      PatchPoints(robot, {"left_sole", "right_sole", "left_peg", "right_peg"});
  for (int trial = 0; trial < 30; ++trial) {
    const VectorXd q = RandomConfiguration(&random, robot);
    const VectorXd v = RandomVector(&random, robot.nv(), 2);
    dynamics.SetState(q, v);
    const CentroidalQuantities before = dynamics.dynamics()->Centroidal();
    const Impact impact = dynamics.Hit(points);
    EXPECT_LT((Jacobians(&dynamics, points) * impact.velocity).norm(), 1e-7 * v.norm());
    EXPECT_GE(impact.energy_lost, 0);
    Vector3d linear = Vector3d::Zero();
    Vector3d angular = Vector3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d arm = dynamics.dynamics()->Position(points[i]) - before.position;
      linear += impact.impulses.col(i);
      angular += arm.cross(impact.impulses.col(i));
    }
    dynamics.SetState(q, impact.velocity);
    const VectorXd gained = dynamics.dynamics()->Centroidal().momentum - before.momentum;
    EXPECT_LT((gained.head<3>() - angular).norm(), 1e-8 * (1 + gained.norm()));
    EXPECT_LT((gained.tail<3>() - linear).norm(), 1e-8 * (1 + gained.norm()));
  }
}

TEST(ForwardDynamics, SolesAreHeldWithStraightKnees) {
  const models::RobotModel robot = DrcHubo();
  ForwardDynamics dynamics(MultibodyModel::Spatial(robot), {kInfinity});
  const std::vector<ContactPoint> points = PatchPoints(robot, {"left_sole", "right_sole"});
  const VectorXd q = VectorXd::Unit(robot.nq(), 0);
  VectorXd v = VectorXd::Zero(robot.nv());
  dynamics.SetState(q, v);
  const ConstrainedMotion& rest = dynamics.Held(v, Hold(&dynamics, points));
  EXPECT_LT((Jacobians(&dynamics, points) * rest.acceleration).norm(), 1e-8);
  EXPECT_TRUE(rest.forces.allFinite());

  // Knees that swing through straight legs at 1 rad/s. Thighs and shanks swing on circles, and only
  // a falling pelvis can provide their centripetal accelerations.
  for (const char* side : {"L", "R"}) {
    v[6 + robot.JointIndex(std::string(side) + "HP")] = -1;
    v[6 + robot.JointIndex(std::string(side) + "KP")] = 2;
    v[6 + robot.JointIndex(std::string(side) + "AP")] = -1;
  }
  dynamics.SetState(q, v);
  const ConstrainedMotion& swing =
      dynamics.Held(VectorXd::Zero(robot.nv()), Hold(&dynamics, points));
  EXPECT_NEAR(swing.acceleration[5], -(0.3299 + 0.33), 1e-6);
}

/// A double pendulum stretched out with its tip held. It cannot accelerate the tip radially.
TEST(ForwardDynamics, NamesThePointThatCannotBeHeld) {
  models::RobotModel arm = Body(1e6, Vector3d::Constant(1e6));
  for (int i = 0; i < 2; ++i) {
    models::Joint joint;
    joint.name = "hinge " + std::to_string(i);
    joint.parent = i;
    joint.axis = Vector3d::UnitY();
    if (i == 1) joint.X_PJ.translation() = Vector3d(1, 0, 0);
    arm.joints.push_back(joint);
    arm.links.push_back(
        {"arm " + std::to_string(i), {1, {0.5, 0, 0}, Eigen::Matrix3d::Identity()}, {}});
  }
  ForwardDynamics dynamics(MultibodyModel::Planar(arm), {kInfinity});
  const std::vector<ContactPoint> points = {{0, {0, 0, 0}}, {0, {0.5, 0, 0.5}}, {2, {1, 0, 0}}};
  VectorXd v = VectorXd::Zero(5);
  dynamics.SetState(VectorXd::Zero(5), v);
  EXPECT_TRUE(dynamics.Held(v, Hold(&dynamics, points)).acceleration.allFinite());
  v[3] = 1;
  v[4] = -2;
  dynamics.SetState(VectorXd::Zero(5), v);
  try {
    dynamics.Held(VectorXd::Zero(5), Hold(&dynamics, points));
    FAIL() << "held";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("point "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("(link '"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("cannot be held"), std::string::npos);
  }
  // Slightly off straight it can, with forces that grow as the angle shrinks.
  double last = 0;
  for (const double bend : {1e-1, 1e-2, 1e-3, 1e-4}) {
    VectorXd q = VectorXd::Zero(5);
    q[3] = bend;
    q[4] = -2 * bend;
    dynamics.SetState(q, v);
    const ConstrainedMotion& motion = dynamics.Held(VectorXd::Zero(5), Hold(&dynamics, points));
    dynamics.dynamics()->SetAcceleration(motion.acceleration);
    EXPECT_LT(dynamics.dynamics()->Acceleration(points[2]).norm(), 1e-6) << bend;
    EXPECT_GT(motion.forces.col(2).norm(), 5 * last);
    last = motion.forces.col(2).norm();
  }
}

TEST(ForwardDynamics, NamesTheJointThatMovesNoMass) {
  models::RobotModel model = Body(1, Vector3d::Ones());
  models::Joint joint;
  joint.name = "weightless";
  model.joints.push_back(joint);
  model.links.resize(2);
  ForwardDynamics dynamics(MultibodyModel::Spatial(model));
  dynamics.SetState(VectorXd::Unit(8, 0), VectorXd::Zero(7));
  try {
    dynamics.Free(VectorXd::Zero(7));
    FAIL() << "solved";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("'weightless'"), std::string::npos) << error.what();
  }
}

TEST(ForwardDynamics, RefusesMalformedArgumentsByName) {
  const auto model = MultibodyModel::Spatial(Body(1, Vector3d(1, 1.5, 2)));
  ForwardDynamics dynamics(model);
  const VectorXd six = VectorXd::Zero(6);
  EXPECT_NE(MessageOf([&] { dynamics.Free(six); }).find("SetState"), std::string::npos);
  dynamics.SetState(VectorXd::Unit(7, 0), six);
  EXPECT_NE(MessageOf([&] { dynamics.Free(VectorXd::Zero(5)); }).find("forces has 5"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] { dynamics.Free(VectorXd::Constant(6, NAN)); }).find("forces"),
            std::string::npos);
  const ContactPoint good{0, Vector3d::Zero()};
  EXPECT_NE(MessageOf([&] {
              dynamics.Hit({good, {3, Vector3d::Zero()}});
            }).find("point 1 is on"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] {
              dynamics.Hit({{0, Vector3d(0, kInfinity, 0)}});
            }).find("point 0"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] {
              dynamics.Held(six, {{good, Vector3d(NAN, 0, 0)}});
            }).find("anchor"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] { ForwardDynamics(model, {0.0}); }).find("drift time"),
            std::string::npos);
  EXPECT_NE(MessageOf([&] { ForwardDynamics(model, {NAN}); }).find("drift time"),
            std::string::npos);
  VectorXd huge = six;
  huge.head<2>().setConstant(1e200);
  EXPECT_NE(MessageOf([&] { dynamics.SetState(VectorXd::Unit(7, 0), huge); }).find("v is so large"),
            std::string::npos);
  // A failed SetState leaves no valid state behind.
  EXPECT_NE(MessageOf([&] { dynamics.Free(six); }).find("SetState"), std::string::npos);
}

}  // namespace
}  // namespace possibility::dynamics
