// The same quantities from DART, whose skeleton has the same numbers. Left out where DART is not
// installed (tests/CMakeLists.txt).

#include <gtest/gtest.h>

#include <random>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "experiments/bench/dart_peer.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using experiments::DartPeer;

constexpr double kTolerance = 1e-9;  // relative

void ExpectAgreementWithDart(const models::RobotModel& robot, int states, std::mt19937* random) {
  DartPeer dart(robot);
  ForwardDynamics ours(MultibodyModel::Spatial(robot));
  SimbodyDynamics simbody(robot);
  for (int state = 0; state < states; ++state) {
    const VectorXd q = RandomConfiguration(random, robot);
    const VectorXd v = RandomVector(random, robot.nv(), 3);
    const VectorXd a = RandomVector(random, robot.nv(), 20);
    const VectorXd forces = RandomVector(random, robot.nv(), 100);
    dart.SetState(q, v);
    ours.SetState(q, v);
    simbody.SetState(q, v);
    ours.dynamics()->SetAcceleration(a);

    const VectorXd required = dart.InverseDynamics(a);
    EXPECT_LT((ours.dynamics()->InverseDynamics() - required).norm(), kTolerance * required.norm());
    EXPECT_LT((simbody.InverseDynamics(a) - required).norm(), kTolerance * required.norm());

    const VectorXd acceleration = dart.ForwardDynamics(forces);
    const double scale = kTolerance * acceleration.norm();
    EXPECT_LT((ours.Free(forces) - acceleration).norm(), scale);
    EXPECT_LT((simbody.ForwardDynamics(forces) - acceleration).norm(), scale);

    const MatrixXd M = dart.MassMatrix();
    EXPECT_LT((ours.dynamics()->MassMatrix() - M).norm(), kTolerance * M.norm());
    EXPECT_LT((simbody.MassMatrix() - M).norm(), kTolerance * M.norm());
  }
}

TEST(Dart, AgreesOnDrcHubo) {
  std::mt19937 random(31);
  ExpectAgreementWithDart(
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml"), 1000,
      &random);
}

TEST(Dart, AgreesOnRandomTrees) {
  std::mt19937 random(32);
  for (int tree = 0; tree < 20; ++tree) {
    ExpectAgreementWithDart(RandomTree(&random, 1 + static_cast<int>(random() % 30)), 20, &random);
  }
}

TEST(Dart, AgreesAtTheIdentityRotation) {
  std::mt19937 random(33);
  const models::RobotModel robot = RandomTree(&random, 5);
  VectorXd q = VectorXd::Zero(robot.nq());
  q[0] = 1;
  const VectorXd v = RandomVector(&random, robot.nv(), 3);
  const VectorXd a = RandomVector(&random, robot.nv(), 20);
  DartPeer dart(robot);
  dart.SetState(q, v);
  SimbodyDynamics simbody(robot);
  simbody.SetState(q, v);
  const VectorXd expected = simbody.InverseDynamics(a);
  EXPECT_LT((dart.InverseDynamics(a) - expected).norm(), kTolerance * expected.norm());
}

}  // namespace
}  // namespace possibility::dynamics
