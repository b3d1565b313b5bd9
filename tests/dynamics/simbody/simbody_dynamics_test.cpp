#include "dynamics/simbody/simbody_dynamics.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/newton_euler.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// All quantities that both engines compute, at random states.
void ExpectAgreementWithSimbody(const models::RobotModel& model, int states, std::mt19937* random) {
  TreeKinematics ours(model);
  SimbodyDynamics simbody(model);
  for (int state = 0; state < states; ++state) {
    const VectorXd q = RandomConfiguration(random, model);
    const VectorXd v = RandomVector(random, model.nv(), 3);
    const VectorXd a = RandomVector(random, model.nv(), 20);
    ours.SetPosition(q);
    ours.SetVelocity(v);
    simbody.SetState(q, v);
    for (int link = 0; link < model.num_links(); ++link) {
      EXPECT_LT((ours.X_WL()[link].matrix() - simbody.LinkPose(link).matrix()).norm(), 1e-12);
    }
    const VectorXd expected = simbody.InverseDynamics(a);
    EXPECT_LT((NewtonEuler(ours, a) - expected).norm(), 1e-10 * expected.norm());

    const int link = static_cast<int>((*random)() % model.num_links());
    const Vector3d p_L = RandomVector(random, 3, 0.5);
    MatrixXd J;
    ours.FrameJacobian(link, p_L, &J);
    EXPECT_LT((ours.Position(link, p_L) - simbody.PointPosition(link, p_L)).norm(), 1e-12);
    EXPECT_LT((ours.Velocity(link, p_L) - simbody.PointVelocity(link, p_L)).norm(), 1e-11);
    EXPECT_LT((J.bottomRows<3>() - simbody.PointJacobian(link, p_L)).norm(), 1e-11);
    const Vector3d bias = simbody.PointBias(link, p_L);
    EXPECT_LT((ours.FrameBias(link, p_L).tail<3>() - bias).norm(), 1e-10 * (1 + bias.norm()));
    EXPECT_LT((ours.CentreOfMass() - simbody.CentreOfMass()).norm(), 1e-12);
    EXPECT_LT((ours.CentreOfMassVelocity() - simbody.CentreOfMassVelocity()).norm(), 1e-11);
  }
}

TEST(SimbodyDynamics, AgreesWithTreeKinematicsOnRandomTrees) {
  std::mt19937 random(7);
  for (int tree = 0; tree < 20; ++tree) {
    ExpectAgreementWithSimbody(RandomTree(&random, 1 + static_cast<int>(random() % 30)), 10,
                               &random);
  }
}

TEST(SimbodyDynamics, AgreesWithTreeKinematicsOnDrcHubo) {
  std::mt19937 random(8);
  const models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  ExpectAgreementWithSimbody(robot, 200, &random);
}

TEST(SimbodyDynamics, MassMatrixMapsAccelerationsToForces) {
  std::mt19937 random(9);
  const models::RobotModel model = RandomTree(&random, 20);
  SimbodyDynamics simbody(model);
  TreeKinematics ours(model);
  for (int trial = 0; trial < 10; ++trial) {
    const VectorXd q = RandomConfiguration(&random, model);
    const VectorXd v = RandomVector(&random, model.nv(), 3);
    const VectorXd a = RandomVector(&random, model.nv(), 10);
    simbody.SetState(q, v);
    ours.SetPosition(q);
    ours.SetVelocity(v);
    const VectorXd forces = NewtonEuler(ours, a);
    const VectorXd expected = forces - NewtonEuler(ours, VectorXd::Zero(model.nv()));
    EXPECT_LT((simbody.MassMatrix() * a - expected).norm(), 1e-11 * forces.norm());
  }
}

TEST(SimbodyDynamics, RefusesInvalidArguments) {
  std::mt19937 random(10);
  const models::RobotModel model = RandomTree(&random, 3);
  SimbodyDynamics simbody(model);
  VectorXd q = RandomConfiguration(&random, model);
  const VectorXd v = VectorXd::Zero(model.nv());
  EXPECT_THROW(simbody.SetState(q, VectorXd::Zero(8)), std::invalid_argument);
  EXPECT_THROW(simbody.SetState(VectorXd::Zero(9), v), std::invalid_argument);
  q[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(simbody.SetState(q, v), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
