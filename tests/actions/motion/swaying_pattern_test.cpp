#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "actions/gait/foothold_plan.h"
#include "actions/motion/pattern_motion.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// Steps of DRC-HUBO1 ahead, from rest to rest, with a root that rolls to the support.
class SwayingPatternTest : public ::testing::Test {
 protected:
  std::vector<Phase> Motion(double sway) const {
    const auto groups = SwingGroups(stance_);
    const PlanarPose start{0.4, -0.3, 0.8};
    const PlanarPose goal = start * PlanarPose{0.5, 0, 0};
    PatternSettings settings;
    const models::ContactSchedule schedule = ScheduleOf(
        robot_, stance_, groups, start,
        PlanSteps(stance_, groups, {start, goal}, {0.28, 0.25, 0.4}), {0.6, 0.4, 0.15, 0.6});
    settings.sways.assign(schedule.intervals.size(), sway);
    VectorXd guess = stance_.q;
    guess.segment<2>(4) = start.position();
    MotionSettings motion;
    motion.minimum_intervals = 6;
    motion.knot_spacing = 0.03;
    return MotionBuilder(robot_, motion)
        .Build(PatternPhases(robot_, stance_, schedule, settings), guess);
  }

  /// Of the root, about its own axis ahead, rad.
  static double RollOf(const Knot& knot) {
    const Eigen::Quaterniond turn(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
    const Eigen::Matrix3d R = turn.toRotationMatrix();
    return std::atan2(R(2, 1), R(2, 2));
  }

  /// Largest torque of the joints that roll the hips, in swings, Nm.
  double HipTorque(const std::vector<Phase>& motion) const {
    double most = 0;
    for (const Phase& phase : motion) {
      if (phase.contacts.size() != 1) continue;
      for (const Knot& knot : phase.knots) {
        for (const char* hip : {"LHR", "RHR"}) {
          most = std::max(most, std::abs(knot.tau[robot_.JointIndex(hip)]));
        }
      }
    }
    return most;
  }

  using VectorXd = Eigen::VectorXd;
  const models::RobotModel& robot_ = DrcHubo1();
  const NominalStance stance_ = SolveNominalStance(robot_, robot_.GaitNamed("walk"));
};

TEST_F(SwayingPatternTest, TheRootRollsToTheLimbThatBearsAndIsUprightAtRest) {
  const double sway = 0.08;
  const std::vector<Phase> motion = Motion(sway);
  EXPECT_NEAR(RollOf(motion.front().knots.front()), 0, 1e-9);
  EXPECT_NEAR(RollOf(motion.back().knots.back()), 0, 1e-9);
  int swings = 0;
  for (const Phase& phase : motion) {
    if (phase.contacts.size() != 1) continue;
    ++swings;
    const Knot& middle = phase.knots[phase.knots.size() / 2];
    const bool left_bears = phase.contacts.front() == "left_sole";
    EXPECT_NEAR(RollOf(middle), left_bears ? -sway : sway, 1e-9);
  }
  EXPECT_GE(swings, 3);
}

TEST_F(SwayingPatternTest, HipsAreSpared) {
  EXPECT_LT(HipTorque(Motion(0.08)), 0.95 * HipTorque(Motion(0)));
}

}  // namespace
}  // namespace possibility::actions
