#include "experiments/viewer/viewer_momentum.h"

#include <gtest/gtest.h>

#include "models/robot/robot_model.h"
#include "tests/actions/drchubo1.h"
#include "tests/dynamics/newton_euler.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// M(q) v: inverse dynamics at rest with v as acceleration, less the part of gravity.
VectorXd GeneralisedMomentum(const VectorXd& q, const VectorXd& v) {
  dynamics::TreeKinematics kinematics(actions::DrcHubo1());
  kinematics.SetPosition(q);
  kinematics.SetVelocity(VectorXd::Zero(v.size()));
  return dynamics::NewtonEuler(kinematics, v) -
         dynamics::NewtonEuler(kinematics, VectorXd::Zero(v.size()));
}

TEST(CentroidalState, MomentumIsTheMassMatrixTimesVelocity) {
  const models::RobotModel& robot = actions::DrcHubo1();
  dynamics::TreeKinematics kinematics(robot);
  std::srand(7);
  for (int i = 0; i < 50; ++i) {
    actions::Knot knot;
    knot.q = VectorXd::Random(robot.nq());
    knot.q.head<4>().normalize();
    knot.v = 3 * VectorXd::Random(robot.nv());
    const CentroidalState state = CentroidalStateAt(knot, &kinematics);
    const VectorXd momentum = GeneralisedMomentum(knot.q, knot.v);
    const Vector3d linear = momentum.segment<3>(3);
    const Vector3d root = knot.q.segment<3>(4);
    const Vector3d angular = momentum.head<3>() - (state.position - root).cross(linear);
    EXPECT_LT((state.linear - linear).norm(), 1e-9 * linear.norm());
    EXPECT_LT((state.angular - angular).norm(), 1e-9 * (1 + angular.norm()));
  }
}

TEST(CentroidalState, LinearMomentumIsTheRateOfTheCentreOfMass) {
  const models::RobotModel& robot = actions::DrcHubo1();
  dynamics::TreeKinematics kinematics(robot);
  std::srand(8);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 20; ++i) {
    actions::Knot knot;
    knot.q = VectorXd::Random(robot.nq());
    knot.q.head<4>() << 1, 0, 0, 0;
    knot.v = VectorXd::Random(robot.nv());
    knot.v.head<3>().setZero();  // so that positions move on straight lines
    const CentroidalState state = CentroidalStateAt(knot, &kinematics);
    const auto centre = [&](double t) {
      actions::Knot moved = knot;
      moved.q.tail(robot.nq() - 4) += t * knot.v.tail(robot.nv() - 3);
      return CentroidalStateAt(moved, &kinematics).position;
    };
    const Vector3d velocity = (centre(kStep) - centre(-kStep)) / (2 * kStep);
    EXPECT_LT((state.linear - robot.TotalMass() * velocity).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace possibility::experiments
