#include "actions/wholebody/force_fault.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "actions/wholebody/required_zero_moment_point.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::actions {
namespace {

using dynamics::ContactForceSettings;
using dynamics::ContactPoint;
using dynamics::kGravity;
using dynamics::MultibodyDynamics;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A body of 10 kg whose centre of mass is at the origin, with a massless limb on a hinge about y,
/// 0.05 m behind the centre of mass.
class ForceFaultTest : public ::testing::Test {
 protected:
  ForceFaultTest() {
    robot_.links.resize(2);
    robot_.links[0].inertial.mass = 10;
    robot_.links[0].inertial.I_LC = Eigen::Matrix3d::Identity();
    models::Joint hinge;
    hinge.name = "hinge";
    hinge.axis = Vector3d::UnitY();
    hinge.effort = 100;
    hinge.X_PJ.translation() = Vector3d(-0.05, 0, 0);
    robot_.joints.push_back(hinge);
  }

  std::string Fault(const std::vector<ContactPoint>& points, const VectorXd& a) {
    MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(robot_));
    dynamics.SetState(VectorXd::Unit(robot_.nq(), 0), VectorXd::Zero(robot_.nv()), a);
    EXPECT_FALSE(DistributeContactForces(&dynamics, points, settings_));
    return ForceFault(&dynamics, points, settings_).what();
  }
  std::string Fault(const std::vector<ContactPoint>& points) {
    return Fault(points, VectorXd::Zero(robot_.nv()));
  }

  static std::vector<ContactPoint> Sole() {
    return {{0, {-0.1, -0.1, -0.5}},
            {0, {0.1, -0.1, -0.5}},
            {0, {0.1, 0.1, -0.5}},
            {0, {-0.1, 0.1, -0.5}}};
  }

  models::RobotModel robot_;
  ContactForceSettings settings_;
};

TEST_F(ForceFaultTest, ATorqueBeyondItsLimitIsNamedWithItsAmount) {
  settings_.torque_margin = 0.5;
  robot_.joints[0].effort = 6;
  // The point right under the centre of mass bears the weight, 0.05 m in front of the hinge.
  const double needed = 0.05 * 10 * kGravity;
  EXPECT_EQ(Fault({{1, {0.05, 0, -0.5}}}), fmt::format("hinge needs {:.1f} of 3.0", needed));
}

TEST_F(ForceFaultTest, TooLittleFrictionIsNamedWithTheCoefficientNeeded) {
  settings_.friction = 0.6;
  settings_.friction_margin = 0.5;
  settings_.cone_edges = 64;
  // Falls forward about the sole's middle: the zero moment point stays in it.
  VectorXd a = VectorXd::Zero(robot_.nv());
  a[3] = 0.4 * kGravity;
  a[1] = 0.5 * a[3] * 10;  // about y: the moment of the force about the centre of mass is I = 1
  a[1] *= -1;
  const std::string fault = Fault(Sole(), a);
  EXPECT_TRUE(fault == "the contacts need a friction of 0.40 of 0.30" ||
              fault == "the contacts need a friction of 0.41 of 0.30")
      << fault;
}

TEST_F(ForceFaultTest, ACentreOfPressureOutsideTheSupportIsNamedWithItsDistance) {
  VectorXd a = VectorXd::Zero(robot_.nv());
  a[3] = 0.25 * kGravity;  // zero moment point 0.125 m behind the centre of mass
  EXPECT_EQ(Fault(Sole(), a), "the centre of pressure is 25 mm outside the support");
}

TEST_F(ForceFaultTest, GroundThatWouldHaveToPullIsNamed) {
  VectorXd a = VectorXd::Zero(robot_.nv());
  a[5] = -1.1 * kGravity;
  EXPECT_EQ(Fault(Sole(), a), "the ground would have to pull");
  EXPECT_EQ(Fault({}), "the motion needs a contact");
}

/// The forces that realise a motion have their centre of pressure at the zero moment point.
TEST(RequiredZeroMomentPointTest, IsTheCentreOfPressureOfForcesOnLevelGround) {
  std::mt19937 random(5);
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    models::RobotModel robot = dynamics::RandomTree(&random, 6);
    for (models::Joint& joint : robot.joints) joint.effort = 1e6;
    MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(robot));
    const VectorXd q = dynamics::RandomConfiguration(&random, robot);
    dynamics.SetState(q, dynamics::RandomVector(&random, robot.nv(), 0.5),
                      dynamics::RandomVector(&random, robot.nv(), 0.5));
    const double ground = q[6] - 1;
    std::vector<ContactPoint> points;
    const Eigen::Isometry3d X_LW = dynamics.kinematics().X_WL()[0].inverse();
    for (const double x : {-3, 3}) {
      for (const double y : {-3, 3}) {
        points.push_back({0, X_LW * Vector3d(q[4] + x, q[5] + y, ground)});
      }
    }
    const auto forces = DistributeContactForces(&dynamics, points, {});
    if (!forces) continue;
    Vector2d centre = Vector2d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      centre += forces->forces(2, i) * dynamics.kinematics().Position(0, points[i].p_L).head<2>();
    }
    centre /= forces->forces.row(2).sum();
    EXPECT_LT((RequiredZeroMomentPoint(&dynamics, ground) - centre).norm(), 1e-8) << trial;
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace possibility::actions
