#include "dynamics/sagittal/mirror_image.h"

#include <gtest/gtest.h>

#include <random>

#include "dynamics/tree/base_joints.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "models/input/input_error.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d OnTheOtherSide(const Vector3d& p) { return {p.x(), -p.y(), p.z()}; }

TEST(MirrorImage, PutsEveryJointWhereItsPartnerWas) {
  std::mt19937 random(1);
  const models::RobotModel robot = DrcHubo();
  const auto model = MultibodyModel::OnJoints(robot);
  const MirrorImage image = MirrorImageOf(robot, *model);
  MultibodyDynamics dynamics(model), mirrored(model);
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd q = RandomVector(&random, model->nq(), 1);
    const VectorXd v = RandomVector(&random, model->nv(), 1);
    dynamics.SetState(q, v);
    mirrored.SetState(image.Of(q), image.Of(v));
    for (const auto& [left, right] : robot.sagittal_pairs) {
      const ContactPoint l{left + 1 + kNumBaseJoints, Vector3d::Zero()};
      const ContactPoint r{right + 1 + kNumBaseJoints, Vector3d::Zero()};
      EXPECT_LT((mirrored.Position(r) - OnTheOtherSide(dynamics.Position(l))).norm(), 1e-9)
          << robot.joints[left].name;
      EXPECT_LT((mirrored.Velocity(l) - OnTheOtherSide(dynamics.Velocity(r))).norm(), 1e-9)
          << robot.joints[right].name;
    }
  }
}

TEST(MirrorImage, OfTheMirrorImageIsTheOriginal) {
  std::mt19937 random(2);
  const models::RobotModel robot = DrcHubo();
  const auto model = MultibodyModel::OnJoints(robot);
  const MirrorImage image = MirrorImageOf(robot, *model);
  const VectorXd q = RandomVector(&random, model->nq(), 1);
  EXPECT_EQ(image.Of(image.Of(q)), q);
}

TEST(MirrorImage, RefusesAnAxisThatIsNotItsPartnersImage) {
  models::RobotModel robot = DrcHubo();
  robot.joints[robot.JointIndex("RSP")].axis = Vector3d(0, 0.8, 0.6);
  EXPECT_THROW(MirrorImageOf(robot, *MultibodyModel::OnJoints(robot)), InputError);
}

TEST(MirrorImage, RefusesALockedPartner) {
  const models::RobotModel robot = DrcHubo();
  const auto model = MultibodyModel::OnJoints(robot, {{robot.JointIndex("RSP"), 0.1}});
  EXPECT_THROW(MirrorImageOf(robot, *model), InputError);
}

}  // namespace
}  // namespace possibility::dynamics
