#include "experiments/legged/walking_step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "collocation/study/optimal_control.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/floating_motion.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::experiments {
namespace {

using collocation::PhaseTrajectory;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kIntervals = 8;

/// The step of all joints, solved once for all tests.
struct SolvedStep {
  SolvedStep() : robot(dynamics::DrcHubo()), model(dynamics::MultibodyModel::OnJoints(robot)) {
    collocation::OptimalControlOptions options;
    options.intervals = {kIntervals};
    const auto problem = WalkingStep(robot, settings);
    result = collocation::SolveOptimalControl(*problem, options);
  }

  static const SolvedStep& Get() {
    static const SolvedStep step;
    return step;
  }

  const PhaseTrajectory& motion() const { return result.trajectory.phases[0]; }
  dynamics::FloatingMotion At(double s) const {
    return dynamics::ToFloating(*model, motion().Coordinates(s, 0), motion().Coordinates(s, 1),
                                motion().Coordinates(s, 2));
  }

  models::RobotModel robot;
  std::shared_ptr<const dynamics::MultibodyModel> model;
  WalkingStepSettings settings;
  collocation::OptimalControlResult result;
};

/// World places of a sole's corners.
std::vector<Vector3d> Corners(const SolvedStep& step, const std::string& contact, double s) {
  const models::ContactPatch& patch = step.robot.contacts[step.robot.ContactIndex(contact)];
  dynamics::SimbodyDynamics simbody(step.robot);
  const dynamics::FloatingMotion at = step.At(s);
  simbody.SetState(at.q, at.v);
  std::vector<Vector3d> corners;
  for (const Vector3d& p_L : patch.points) {
    corners.push_back(simbody.PointPosition(patch.link, p_L));
  }
  return corners;
}

TEST(WalkingStep, IsSolvedFromThePosture) {
  EXPECT_EQ(SolvedStep::Get().result.status, collocation::SolverStatus::kSolved);
}

TEST(WalkingStep, BalancesInAnotherEngine) {
  const SolvedStep& step = SolvedStep::Get();
  const PhaseTrajectory& motion = step.motion();
  const models::ContactPatch& sole = step.robot.contacts[step.robot.ContactIndex("left_sole")];
  dynamics::SimbodyDynamics simbody(step.robot);
  for (int point = 0; point < motion.num_points(); ++point) {
    const dynamics::FloatingMotion at = step.At(motion.PointShare(point));
    simbody.SetState(at.q, at.v);
    VectorXd residual = simbody.InverseDynamics(at.a);
    const VectorXd controls = motion.controls.col(point);
    const int num_forces = 3 * static_cast<int>(sole.points.size());
    for (std::size_t i = 0; i < sole.points.size(); ++i) {
      residual -= simbody.PointJacobian(sole.link, sole.points[i]).transpose() *
                  controls.segment<3>(3 * static_cast<int>(i));
    }
    residual.tail(step.robot.num_joints()) -= controls.tail(controls.size() - num_forces);
    EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-4) << "N or N m, at point " << point;
  }
}

TEST(WalkingStep, KeepsForcesWithinConesAndTorquesWithinLimits) {
  const SolvedStep& step = SolvedStep::Get();
  const PhaseTrajectory& motion = step.motion();
  for (int point = 0; point < motion.num_points(); ++point) {
    for (int corner = 0; corner < 4; ++corner) {
      const Vector3d f = motion.controls.col(point).segment<3>(3 * corner);
      EXPECT_GE(f.z(), -1e-4);
      EXPECT_LE(f.head<2>().norm(), step.robot.friction * f.z() + 1e-3);
    }
    for (int joint = 0; joint < step.robot.num_joints(); ++joint) {
      EXPECT_LE(std::abs(motion.controls(12 + joint, point)),
                step.robot.joints[joint].effort + 1e-4);
    }
  }
}

TEST(WalkingStep, HoldsTheStanceSoleAndSwingsTheOtherTwoStepsAhead) {
  const SolvedStep& step = SolvedStep::Get();
  // The sole's place is fixed at the start. Later knots hold its velocity and acceleration, so it
  // drifts by the error of the intervals between them.
  constexpr double kDrift = 2e-4;  // m
  const double length = step.settings.speed * step.settings.duration;
  const auto stance = Corners(step, "left_sole", 0);
  const auto begin = Corners(step, "right_sole", 0);
  const auto end = Corners(step, "right_sole", 1);
  for (int corner = 0; corner < 4; ++corner) {
    EXPECT_NEAR(stance[corner].z(), 0, 1e-6);
    EXPECT_LT((end[corner] - begin[corner] - Vector3d(2 * length, 0, 0)).norm(), kDrift);
    EXPECT_NEAR(begin[corner].z(), 0, kDrift);
  }
  for (double s = 0; s <= 1; s += 0.01) {
    const auto held = Corners(step, "left_sole", s);
    for (int corner = 0; corner < 4; ++corner) {
      EXPECT_LT((held[corner] - stance[corner]).norm(), 5e-4) << "between knots, s = " << s;
    }
  }
  for (const Vector3d& corner : Corners(step, "right_sole", 0.5)) {
    EXPECT_GE(corner.z(), step.settings.clearance - 1e-6);
  }
}

TEST(WalkingStep, WithLockedArmsHas23Coordinates) {
  const models::RobotModel robot = dynamics::DrcHubo();
  const auto problem = WalkingStep(robot, {.joints = StepJoints::kLegsAndSwingingArms});
  EXPECT_EQ(problem->phase(0).coordinates().size(), 23);
  EXPECT_EQ(WalkingStep(robot)->phase(0).coordinates().size(), 33);
}

}  // namespace
}  // namespace possibility::experiments
