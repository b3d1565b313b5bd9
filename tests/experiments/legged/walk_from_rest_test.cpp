#include "experiments/legged/walk_from_rest.h"

#include <gtest/gtest.h>

#include "collocation/study/optimal_control.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;

constexpr int kPhaseIntervals = 3;  // per phase
constexpr int kJoints = 17;    // legs and swinging arms

/// The integral over a phase, by Simpson's rule, of the contact forces' sum, N s. Controls are the
/// forces, then the torques.
Vector3d ImpulseOf(const collocation::PhaseTrajectory& phase) {
  const Eigen::Index num_forces = (phase.controls.rows() - kJoints) / 3;
  Vector3d impulse = Vector3d::Zero();
  for (int point = 0; point < phase.num_points(); ++point) {
    const bool is_end = point == 0 || point + 1 == phase.num_points();
    const double weight = is_end ? 1 : point % 2 == 1 ? 4 : 2;
    for (Eigen::Index i = 0; i < num_forces; ++i) {
      impulse += weight * phase.controls.col(point).segment<3>(3 * i);
    }
  }
  return impulse * phase.duration / (6 * kPhaseIntervals);
}

TEST(WalkFromRest, ComesToRestAheadWithoutANetImpulse) {
  const models::RobotModel robot = dynamics::DrcHubo();
  const auto problem = WalkFromRest(robot, {.distance = 0.3});
  collocation::OptimalControlOptions options;
  options.intervals = {kPhaseIntervals};
  const auto result = collocation::SolveOptimalControl(*problem, options);
  ASSERT_TRUE(result.succeeded()) << result.message;
  const auto& phases = result.trajectory.phases;
  EXPECT_EQ(phases.size(), 5U) << "two steps";
  EXPECT_NEAR(phases.back().Coordinates(1)[0] - phases.front().Coordinates(0)[0], 0.3, 1e-9);
  EXPECT_LT(phases.back().Coordinates(1, 1).norm(), 1e-9);

  Vector3d impulse = Vector3d::Zero();
  double duration = 0, mass = 0;
  for (const auto& phase : phases) {
    impulse += ImpulseOf(phase);
    duration += phase.duration;
  }
  for (const models::Link& link : robot.links) mass += link.inertial.mass;
  const double weight = mass * dynamics::kGravity;
  // From rest to rest the ground gives the momentum that gravity takes.
  EXPECT_NEAR(impulse.z() / (weight * duration), 1, 1e-3);
  EXPECT_LT(impulse.head<2>().norm() / (weight * duration), 1e-3);
}

}  // namespace
}  // namespace possibility::experiments
