#include "dynamics/tree/multibody_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "dynamics/tree/multibody_dynamics.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/richardson.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Joint 1 is -2 times joint 3 plus 0.5. Joint 3 comes after it.
models::RobotModel Coupled(std::mt19937* random) {
  models::RobotModel tree = RandomTree(random, 5);
  tree.joints[1].mimic = models::Mimic{3, -2, 0.5};
  return tree;
}

TEST(MultibodyModelTest, AMimicJointAddsNoCoordinate) {
  std::mt19937 random(1);
  const models::RobotModel tree = Coupled(&random);
  const auto model = MultibodyModel::Spatial(tree);
  ASSERT_EQ(model->nv(), 10);
  ASSERT_EQ(model->nq(), 11);
  EXPECT_FALSE(model->is_identity());
  EXPECT_EQ(model->joints(), (std::vector<int>{0, 2, 3, 4}));

  const VectorXd q = RandomConfiguration(&random, tree).head(11);
  const VectorXd tree_q = model->TreeConfiguration(q);
  EXPECT_EQ(tree_q.head(8), q.head(8));
  EXPECT_EQ(tree_q[8], -2 * q[9] + 0.5);
  EXPECT_EQ(tree_q.tail(3), q.tail(3));
  const VectorXd v = RandomVector(&random, 10, 1);
  const VectorXd tree_v = model->TreeVelocity(v);
  EXPECT_EQ(tree_v[7], -2 * v[8]);
  EXPECT_EQ(tree_v.tail(3), v.tail(3));
  // The power is the same in both coordinates.
  const VectorXd forces = RandomVector(&random, 11, 10);
  EXPECT_NEAR(model->IndependentForces(forces).dot(v), forces.dot(tree_v), 1e-12);
}

TEST(MultibodyModelTest, TheMastersLimitsKeepTheMimicWithinItsOwn) {
  std::mt19937 random(2);
  models::RobotModel tree = Coupled(&random);
  tree.joints[1].lower = -1.5;
  tree.joints[1].upper = 2;
  tree.joints[1].velocity = 4;
  const auto model = MultibodyModel::Spatial(tree);
  // -1.5 <= -2 q + 0.5 <= 2
  EXPECT_DOUBLE_EQ(model->lower()[2], -0.75);
  EXPECT_DOUBLE_EQ(model->upper()[2], 1);
  EXPECT_DOUBLE_EQ(model->velocity()[2], 2);
  EXPECT_DOUBLE_EQ(model->effort()[2], 500);
  EXPECT_DOUBLE_EQ(model->upper()[0], 2);
}

TEST(MultibodyModelTest, TheRateOfAConfigurationIsItsDisplacementPerTime) {
  std::mt19937 random(3);
  const auto model = MultibodyModel::Spatial(Coupled(&random));
  for (int i = 0; i < 100; ++i) {
    VectorXd q = RandomVector(&random, model->nq(), 1);
    q.head<4>().normalize();
    const VectorXd v = RandomVector(&random, model->nv(), 2);
    const VectorXd difference =
        RichardsonDerivative([&](double t) -> VectorXd { return model->Displaced(q, t * v); });
    EXPECT_LT(RelativeError(model->ConfigurationRate(q, v), difference), 1e-9);
  }
}

TEST(MultibodyModelTest, APlanarModelMovesInItsPlane) {
  std::mt19937 random(4);
  models::RobotModel tree = RandomTree(&random, 2);
  tree.joints[0].type = models::JointType::kRevolute;
  tree.joints[0].axis = Vector3d::UnitY();
  tree.joints[1].type = models::JointType::kPrismatic;
  tree.joints[1].parent = 1;
  tree.joints[1].axis = Vector3d::UnitX();
  for (models::Joint& joint : tree.joints) {
    joint.X_PJ = Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::Isometry3d::Identity();
  }
  const auto model = MultibodyModel::Planar(tree);
  ASSERT_EQ(model->nq(), 5);
  MultibodyDynamics dynamics(model);
  VectorXd q(5);
  q << 0.4, 1, 2, 0.3, 0.5;
  dynamics.SetState(q, VectorXd::Zero(5));
  const Eigen::AngleAxisd pitch(0.4, Vector3d::UnitY());
  const Eigen::AngleAxisd both(0.7, Vector3d::UnitY());
  const Vector3d expected = Vector3d(1, 0, 2) + pitch * Vector3d(0.1, 0.2, 0.3) +
                            both * (Vector3d(0.1, 0.2, 0.3) + Vector3d(0.5, 0, 0));
  EXPECT_LT((dynamics.Position({2, Vector3d::Zero()}) - expected).norm(), 1e-14);
  EXPECT_EQ(model->Displaced(q, VectorXd::Ones(5)), q + VectorXd::Ones(5));
}

TEST(MultibodyModelTest, ALockedJointStaysWhereItIs) {
  std::mt19937 random(7);
  models::RobotModel tree = RandomTree(&random, 5);
  tree.joints[4].mimic = models::Mimic{1, 3, 0.2};
  const auto locked = MultibodyModel::OnJoints(tree, {{1, 0.3}});
  const auto free = MultibodyModel::OnJoints(tree);
  EXPECT_EQ(locked->num_joints(), 3);
  EXPECT_EQ(locked->joints(), (std::vector<int>{6, 8, 9}));
  const VectorXd q = RandomVector(&random, 9, 1);
  VectorXd with_locked(10);
  with_locked << q.head(7), 0.3, q.tail(2);
  EXPECT_EQ(locked->TreeConfiguration(q), free->TreeConfiguration(with_locked));
  EXPECT_EQ(locked->TreeVelocity(q)[6 + 7], 0);
  EXPECT_EQ(locked->TreeVelocity(q)[6 + 10], 0);  // the mimic of the locked joint
  EXPECT_THROW(MultibodyModel::OnJoints(tree, {{5, 0}}), std::invalid_argument);
  EXPECT_THROW(MultibodyModel::OnJoints(tree, {{4, 0}}), std::invalid_argument);
  EXPECT_THROW(MultibodyModel::OnJoints(tree, {{1, std::nan("")}}), std::invalid_argument);
}

TEST(MultibodyModelTest, KnowsWhichVelocitiesMoveWhichLinks) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 20; ++trial) {
    models::RobotModel tree = RandomTree(&random, 6);
    if (trial % 2 == 0) tree.joints[1].mimic = models::Mimic{3, -2, 0.5};
    for (const auto& model : {MultibodyModel::Spatial(tree), MultibodyModel::OnJoints(tree)}) {
      MultibodyDynamics dynamics(model);
      VectorXd q = RandomVector(&random, model->nq(), 1);
      if (model->base() == Base::kFloating) q.head<4>().normalize();
      dynamics.SetState(q, VectorXd::Zero(model->nv()));
      MatrixXd J(3, model->nv());
      for (int link = 0; link < model->tree().num_links(); ++link) {
        dynamics.Jacobian({link, RandomVector(&random, 3, 0.3)}, J);
        for (int i = 0; i < model->nv(); ++i) {
          EXPECT_EQ(J.col(i).isZero(0), !model->Moves(i, link)) << i << " " << link;
        }
      }
      const MatrixXd M = dynamics.MassMatrix();
      for (int i = 6; i < model->nv(); ++i) {
        for (int j = 6; j < model->nv(); ++j) {
          EXPECT_EQ(M(i, j) == 0.0, !model->AreRelated(i, j)) << i << " " << j;
        }
      }
    }
  }
}

TEST(MultibodyModelTest, RefusesInvalidModelsAndSizes) {
  std::mt19937 random(5);
  models::RobotModel tree = Coupled(&random);
  tree.joints[3].mimic = models::Mimic{1, 1, 0};
  EXPECT_THROW(MultibodyModel::Spatial(tree), std::invalid_argument);
  EXPECT_THROW(MultibodyModel::Planar(RandomTree(&random, 4)), std::invalid_argument);
  const auto model = MultibodyModel::Spatial(Coupled(&random));
  EXPECT_THROW(model->TreeConfiguration(VectorXd::Zero(3)), std::invalid_argument);
  EXPECT_THROW(model->TreeVelocity(VectorXd::Zero(3)), std::invalid_argument);
  EXPECT_THROW(model->Displaced(VectorXd::Zero(11), VectorXd::Zero(11)), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
