#include "actions/motion/free_flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "actions/plan/interpolation.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Joints that swing about their walking stance, each at a frequency of its own.
JointMotion Swinging(const VectorXd& middle, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  VectorXd amplitude(middle.size());
  VectorXd frequency(middle.size());
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    amplitude[i] = 0.4 * uniform(*random);
    frequency[i] = 6 + 3 * uniform(*random);
  }
  return [=](double t) {
    Signal<VectorXd> joints{middle, VectorXd(middle.size()), VectorXd(middle.size())};
    for (Eigen::Index i = 0; i < middle.size(); ++i) {
      const double w = frequency[i];
      joints.value[i] += amplitude[i] * std::sin(w * t);
      joints.rate[i] = amplitude[i] * w * std::cos(w * t);
      joints.acceleration[i] = -amplitude[i] * w * w * std::sin(w * t);
    }
    return joints;
  };
}

class FreeFlightTest : public ::testing::Test {
 protected:
  FreeFlightTest() : random_(7), joints_(Swinging(Stance().tail(robot().num_joints()), &random_)) {
    std::normal_distribution<double> normal;
    q_ = Stance();
    q_.tail(robot().num_joints()) = joints_(0).value;
    v_.setZero(robot().nv());
    for (int i = 0; i < 6; ++i) v_[i] = normal(random_);
    v_.tail(robot().num_joints()) = joints_(0).rate;
  }

  static const models::RobotModel& robot() { return DrcHubo1(); }
  static VectorXd Stance() { return robot().Configuration(robot().GaitNamed("walk").posture); }

  std::vector<Knot> Fly(int intervals) {
    FreeFlight flight(dynamics::MultibodyModel::Spatial(robot()));
    flight.TakeOff(q_, v_);
    return flight.Fly(joints_, 0.4, intervals);
  }

  std::mt19937 random_;
  JointMotion joints_;
  VectorXd q_, v_;
};

TEST_F(FreeFlightTest, BeginsAtTakeOffAndFollowsTheJoints) {
  const std::vector<Knot> knots = Fly(40);
  ASSERT_EQ(knots.size(), 41u);
  EXPECT_LT((knots.front().q - q_).norm(), 1e-12);
  EXPECT_LT((knots.front().v - v_).norm(), 1e-11);
  for (const Knot& knot : knots) {
    EXPECT_LT((knot.q.tail(robot().num_joints()) - joints_(knot.t).value).norm(), 1e-14);
  }
}

TEST_F(FreeFlightTest, SimbodyFindsNoForceOnTheRoot) {
  dynamics::SimbodyDynamics simbody(robot());
  for (const Knot& knot : Fly(40)) {
    simbody.SetState(knot.q, knot.v);
    const VectorXd forces = simbody.InverseDynamics(knot.a);
    EXPECT_LT(forces.head<6>().cwiseAbs().maxCoeff(), 1e-8) << knot.t;
    EXPECT_LT((forces.tail(robot().num_joints()) - knot.tau).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_F(FreeFlightTest, SimbodysMomentumFallsFreely) {
  dynamics::SimbodyDynamics simbody(robot());
  simbody.SetState(q_, v_);
  const Vector3d p = simbody.CentreOfMass();
  const Vector3d velocity = simbody.CentreOfMassVelocity();
  const Vector3d angular = simbody.CentroidalMomentum().head<3>();
  const Vector3d fall(0, 0, -dynamics::kGravity);
  for (const Knot& knot : Fly(40)) {
    const double t = knot.t;
    simbody.SetState(knot.q, knot.v);
    EXPECT_LT((simbody.CentreOfMass() - p - t * velocity - t * t / 2 * fall).norm(), 1e-10);
    EXPECT_LT((simbody.CentreOfMassVelocity() - velocity - t * fall).norm(), 1e-10);
    EXPECT_LT((simbody.CentroidalMomentum().head<3>() - angular).norm(), 1e-9 * angular.norm());
  }
}

TEST_F(FreeFlightTest, OrientationConvergesWithTheFourthPowerOfTheStep) {
  const auto end = [this](int intervals) { return VectorXd(Fly(intervals).back().q.head<4>()); };
  const VectorXd exact = end(640);
  const double coarse = (end(20) - exact).norm();
  const double fine = (end(40) - exact).norm();
  EXPECT_GT(std::log2(coarse / fine), 3.7);
  EXPECT_LT(fine, 1e-5);
}

TEST_F(FreeFlightTest, VelocityIsTheDerivativeOfPosition) {
  const std::vector<Knot> knots = Fly(400);
  for (std::size_t i = 1; i + 1 < knots.size(); i += 20) {
    // The quintic between two knots agrees with both halves at the middle if q, v and a are
    // consistent.
    const Knot middle = Interpolate(knots[i - 1], knots[i + 1], knots[i].t);
    EXPECT_LT((middle.q - knots[i].q).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((middle.v - knots[i].v).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST_F(FreeFlightTest, LandGivesTheLastKnotOfFly) {
  FreeFlight flight(dynamics::MultibodyModel::Spatial(robot()));
  flight.TakeOff(q_, v_);
  const Knot landed = flight.Land(joints_, 0.4, 40);
  EXPECT_EQ(landed.q, Fly(40).back().q);
}

}  // namespace
}  // namespace possibility::actions
