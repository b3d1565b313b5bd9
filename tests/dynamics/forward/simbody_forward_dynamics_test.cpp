// Simbody's forward dynamics and energies, compared with our inverse dynamics and first principles.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>

#include "common/blas_threads.h"
#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/newton_euler.h"
#include "tests/dynamics/random_robot.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

models::RobotModel DrcHubo1() {
  return models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
}

/// Every third joint mimics some joint that is not a mimic.
models::RobotModel RandomCoupledTree(std::mt19937* random, int num_joints) {
  models::RobotModel model = RandomTree(random, num_joints);
  for (int i = 0; i < num_joints; i += 3) {
    int master = 0;
    while (master % 3 == 0) master = static_cast<int>((*random)() % num_joints);
    const double multiplier = Uniform(random, 0.5, 2) * ((*random)() % 2 == 0 ? 1 : -1);
    model.joints[i].mimic = models::Mimic{master, multiplier, Uniform(random, -1, 1)};
  }
  return model;
}

/// Columns: the velocities of the whole tree for a unit of each independent velocity.
MatrixXd CouplingMatrix(const models::RobotModel& model) {
  MatrixXd C = MatrixXd::Identity(model.nv(), model.nv());
  std::vector<int> independent;
  for (int i = 0; i < model.nv(); ++i) {
    if (i < 6 || !model.joints[i - 6].mimic) independent.push_back(i);
  }
  for (int j = 0; j < model.num_joints(); ++j) {
    const auto& mimic = model.joints[j].mimic;
    if (mimic) C(6 + j, 6 + mimic->joint) = mimic->multiplier;
  }
  return C(Eigen::all, independent);
}

struct RandomRobotState {
  RandomRobotState(std::mt19937* random, const models::RobotModel& model)
      : q(RandomConfiguration(random, model)),
        v(RandomVector(random, model.nv(), 3)),
        forces(RandomVector(random, model.nv(), 100)) {}
  VectorXd q, v, forces;
};

TEST(SimbodyForwardDynamics, UndoesInverseDynamics) {
  std::mt19937 random(21);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model =
        tree == 0 ? DrcHubo1() : RandomTree(&random, 1 + static_cast<int>(random() % 30));
    TreeKinematics ours(model);
    SimbodyDynamics simbody(model);
    for (int trial = 0; trial < 10; ++trial) {
      const RandomRobotState state(&random, model);
      const VectorXd a = RandomVector(&random, model.nv(), 20);
      ours.SetPosition(state.q);
      ours.SetVelocity(state.v);
      simbody.SetState(state.q, state.v);
      EXPECT_LT((simbody.ForwardDynamics(NewtonEuler(ours, a)) - a).norm(), 1e-9 * a.norm());
    }
  }
}

/// Simbody has every rotor as a body of its own.
TEST(SimbodyForwardDynamics, AgreesWithOursOnRobotsWithActuators) {
  std::mt19937 random(27);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model =
        WithActuators(tree % 2 == 0 ? RandomTree(&random, 1 + static_cast<int>(random() % 12))
                                    : RandomCoupledTree(&random, 6),
                      &random);
    const auto coupled = MultibodyModel::Spatial(model);
    ForwardDynamics ours(coupled);
    SimbodyDynamics simbody(model);
    for (int trial = 0; trial < 5; ++trial) {
      VectorXd q = RandomVector(&random, coupled->nq(), 1);
      q.head<4>().normalize();
      const VectorXd v = RandomVector(&random, coupled->nv(), 3);
      VectorXd forces = RandomVector(&random, model.nv(), 100);
      ours.SetState(q, v);
      simbody.SetState(coupled->TreeConfiguration(q), coupled->TreeVelocity(v));
      const VectorXd expected =
          coupled->TreeVelocity(ours.Free(coupled->IndependentForces(forces)));
      EXPECT_LT((simbody.ForwardDynamics(forces) - expected).norm(), 1e-8 * expected.norm());
      EXPECT_NEAR(simbody.KineticEnergy(), v.dot(ours.dynamics()->MassMatrix() * v) / 2,
                  1e-9 * simbody.KineticEnergy());
    }
  }
}

TEST(SimbodyForwardDynamics, MimicJointsFollowTheirMasters) {
  std::mt19937 random(22);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model =
        RandomCoupledTree(&random, 5 + static_cast<int>(random() % 20));
    const MatrixXd C = CouplingMatrix(model);
    TreeKinematics ours(model);
    SimbodyDynamics simbody(model);
    for (int trial = 0; trial < 5; ++trial) {
      const RandomRobotState state(&random, model);
      ours.SetPosition(state.q);
      ours.SetVelocity(state.v);
      simbody.SetState(state.q, state.v);
      const VectorXd a = simbody.ForwardDynamics(state.forces);
      for (int j = 0; j < model.num_joints(); ++j) {
        const auto& mimic = model.joints[j].mimic;
        if (!mimic) continue;
        EXPECT_NEAR(a[6 + j], mimic->multiplier * a[6 + mimic->joint], 1e-9 * a.norm());
      }
      // The couplings do no work, so the residual forces do no work in any coupled motion.
      const VectorXd required = NewtonEuler(ours, a);
      EXPECT_LT((C.transpose() * (required - state.forces)).norm(), 1e-8 * required.norm());
    }
  }
}

/// Held points do not accelerate, and their forces are all that they do to the robot.
void ExpectHeld(const RandomRobotState& state, const std::vector<ContactPoint>& held,
                TreeKinematics* ours, SimbodyDynamics* simbody) {
  ours->SetPosition(state.q);
  ours->SetVelocity(state.v);
  simbody->SetState(state.q, state.v);
  const auto [a, forces] = simbody->ForwardDynamics(state.forces, held);
  ASSERT_EQ(forces.cols(), static_cast<Eigen::Index>(held.size()));
  VectorXd acting = state.forces;
  for (std::size_t i = 0; i < held.size(); ++i) {
    MatrixXd J(3, state.v.size());
    ours->PointJacobian(held[i].link, held[i].p_L, J);
    const Vector3d acceleration = J * a + ours->FrameBias(held[i].link, held[i].p_L).tail<3>();
    EXPECT_LT(acceleration.norm(), 1e-8 * (1 + a.norm()));
    ours->AddPointForce(held[i].link, held[i].p_L, forces.col(i), &acting);
  }
  const VectorXd required = NewtonEuler(*ours, a);
  EXPECT_LT((required - acting).norm(), 1e-8 * required.norm());
}

TEST(SimbodyForwardDynamics, HoldsPoints) {
  std::mt19937 random(23);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model = RandomTree(&random, 10 + static_cast<int>(random() % 20));
    TreeKinematics ours(model);
    SimbodyDynamics simbody(model);
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<ContactPoint> held;
      for (int i = 0; i < trial % 3; ++i) {
        held.push_back({model.num_joints() * (i + 1) / 2, RandomVector(&random, 3, 0.3)});
      }
      ExpectHeld(RandomRobotState(&random, model), held, &ours, &simbody);
    }
  }
}

TEST(SimbodyForwardDynamics, HoldsTheSolesOfDrcHubo) {
  std::mt19937 random(24);
  const models::RobotModel model = DrcHubo1();
  TreeKinematics ours(model);
  SimbodyDynamics simbody(model);
  std::vector<ContactPoint> held;
  for (const models::ContactPatch& patch : model.contacts) {
    if (patch.points.size() < 4) continue;
    for (const Vector3d& p_L : patch.points) held.push_back({patch.link, p_L});
  }
  ASSERT_EQ(held.size(), 8u);  // 24 rows of which 12 are independent
  for (int trial = 0; trial < 20; ++trial) {
    RandomRobotState state(&random, model);
    state.v.setZero();  // four points of one body that turns cannot all be without acceleration
    ExpectHeld(state, held, &ours, &simbody);
  }
}

TEST(SimbodyForwardDynamics, EnergiesAndMomentumAreTheSumsOverTheLinks) {
  std::mt19937 random(25);
  for (int tree = 0; tree < 20; ++tree) {
    const models::RobotModel model =
        tree == 0 ? DrcHubo1() : RandomTree(&random, 1 + static_cast<int>(random() % 30));
    const RandomRobotState state(&random, model);
    TreeKinematics ours(model);
    SimbodyDynamics simbody(model);
    ours.SetPosition(state.q);
    ours.SetVelocity(state.v);
    simbody.SetState(state.q, state.v);
    const Vector3d com = ours.CentreOfMass();
    double kinetic = 0;
    double potential = 0;
    Eigen::Matrix<double, 6, 1> momentum = Eigen::Matrix<double, 6, 1>::Zero();
    for (int link = 0; link < model.num_links(); ++link) {
      const models::Inertial& body = model.links[link].inertial;
      const Eigen::Matrix3d R = ours.X_WL()[link].linear();
      const Vector3d w = ours.AngularVelocity(link);
      const Vector3d c = ours.Position(link, body.p_LC);
      const Vector3d v = ours.Velocity(link, body.p_LC);
      const Vector3d spin = R * body.I_LC * R.transpose() * w;
      kinetic += (body.mass * v.squaredNorm() + w.dot(spin)) / 2;
      potential += body.mass * kGravity * c.z();
      momentum.head<3>() += spin + body.mass * (c - com).cross(v);
      momentum.tail<3>() += body.mass * v;
    }
    EXPECT_NEAR(simbody.KineticEnergy(), kinetic, 1e-11 * kinetic);
    EXPECT_NEAR(simbody.PotentialEnergy(), potential, 1e-11 * (kinetic + std::abs(potential)));
    EXPECT_LT((simbody.CentroidalMomentum() - momentum).norm(), 1e-11 * momentum.norm());
  }
}

/// All results at a state, in one vector.
VectorXd Answers(const RandomRobotState& state, const std::vector<ContactPoint>& held,
                 SimbodyDynamics* simbody) {
  simbody->SetState(state.q, state.v);
  const SimbodyDynamics::HeldMotion motion = simbody->ForwardDynamics(state.forces, held);
  VectorXd answers(3 * state.v.size() + motion.forces.size());
  answers << simbody->InverseDynamics(state.forces), simbody->ForwardDynamics(state.forces),
      motion.acceleration, motion.forces.reshaped();
  return answers;
}

TEST(SimbodyForwardDynamics, ThreadsDoNotDisturbEachOther) {
  // Such a BLAS spoils one run of this test in some two hundred.
  ASSERT_FALSE(BlasIsForOneThread()) << "Simbody's BLAS: install libopenblas0-pthread";
  std::mt19937 random(26);
  const models::RobotModel model = RandomCoupledTree(&random, 20);
  const std::vector<ContactPoint> held = {{10, {0.1, 0, 0}}, {20, {0, 0.1, 0}}};
  std::vector<RandomRobotState> states;
  for (int i = 0; i < 100; ++i) states.emplace_back(&random, model);
  std::vector<VectorXd> alone;
  SimbodyDynamics simbody(model);
  for (const RandomRobotState& state : states) alone.push_back(Answers(state, held, &simbody));
  std::vector<VectorXd> together[2];
  {
    std::vector<std::jthread> threads;
    for (std::vector<VectorXd>& answers : together) {
      threads.emplace_back([&] {
        SimbodyDynamics own(model);
        for (const RandomRobotState& state : states) answers.push_back(Answers(state, held, &own));
      });
    }
  }
  EXPECT_EQ(together[0], alone);
  EXPECT_EQ(together[1], alone);
}

TEST(SimbodyForwardDynamics, RefusesInvalidArguments) {
  std::mt19937 random(27);
  const models::RobotModel model = RandomTree(&random, 3);
  SimbodyDynamics simbody(model);
  const RandomRobotState state(&random, model);
  simbody.SetState(state.q, state.v);
  VectorXd nan = state.forces;
  nan[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MessageOf([&] { simbody.ForwardDynamics(VectorXd::Zero(8)); }),
            "SimbodyDynamics: forces has 8 elements, expected 9");
  EXPECT_EQ(MessageOf([&] { simbody.ForwardDynamics(nan); }),
            "SimbodyDynamics: forces is not finite");
  EXPECT_EQ(MessageOf([&] { simbody.ForwardDynamics(nan, {}); }),
            "SimbodyDynamics: forces is not finite");
  for (const int link : {-1, 4}) {
    EXPECT_EQ(MessageOf([&] {
                simbody.ForwardDynamics(state.forces, {{link, Vector3d::Zero()}});
              }),
              "SimbodyDynamics: a held point is on link " + std::to_string(link) +
                  ", which the robot has not");
  }
  EXPECT_EQ(MessageOf([&] {
              simbody.ForwardDynamics(state.forces, {{0, nan.head<3>()}});
            }),
            "SimbodyDynamics: a held point is not finite");
}

}  // namespace
}  // namespace possibility::dynamics
