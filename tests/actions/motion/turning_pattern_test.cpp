#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "actions/gait/foothold_plan.h"
#include "actions/gait/waist_joint.h"
#include "actions/motion/pattern_motion.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

constexpr double kHeading = 0.8;  // of the way, rad

/// Steps of DRC-HUBO1 ahead, from rest to rest, with a root that turns and a trunk that twists.
class TurningPatternTest : public ::testing::Test {
 protected:
  std::vector<Phase> Motion(double turn, double twist, double share = 1) const {
    const auto groups = SwingGroups(stance_);
    const PlanarPose start{0.4, -0.3, kHeading};
    const PlanarPose goal = start * PlanarPose{1.1, 0, 0};
    PatternSettings settings;
    const models::ContactSchedule schedule = ScheduleOf(
        robot_, stance_, groups, start,
        PlanSteps(stance_, groups, {start, goal}, {0.28, 0.25, 0.4}), {0.5, 0.28, 0.1, 0.5});
    settings.turn = turn;
    settings.twist = twist;
    settings.waist = WaistJoint(robot_, stance_);
    settings.shares.assign(schedule.intervals.size(), share);
    Eigen::VectorXd guess = stance_.q;
    guess.segment<2>(4) = start.position();
    return MotionBuilder(robot_).Build(PatternPhases(robot_, stance_, schedule, settings), guess);
  }

  /// Yaw of a link against the way, rad.
  double YawOf(const char* link, const Knot& knot) const {
    dynamics::TreeKinematics kinematics(robot_);
    kinematics.SetPosition(knot.q);
    for (std::size_t i = 0; i < robot_.links.size(); ++i) {
      if (robot_.links[i].name != link) continue;
      const Eigen::Matrix3d R = kinematics.X_WL()[i].linear();
      return std::atan2(R(1, 0), R(0, 0)) - kHeading;
    }
    ADD_FAILURE() << "no link " << link;
    return 0;
  }

  /// Greatest moment of the contact forces about the vertical through the foot that bears alone,
  /// N m.
  double TurningMoment(const std::vector<Phase>& motion) const {
    double most = 0;
    dynamics::TreeKinematics kinematics(robot_);
    for (const Phase& phase : motion) {
      if (phase.contacts.size() != 1) continue;
      const auto patch =
          std::find_if(robot_.contacts.begin(), robot_.contacts.end(),
                       [&](const auto& one) { return one.name == phase.contacts.front(); });
      for (const Knot& knot : phase.knots) {
        kinematics.SetPosition(knot.q);
        const Eigen::Isometry3d& X_WL = kinematics.X_WL()[patch->link];
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const auto& p : patch->points) middle += X_WL * p / patch->points.size();
        double moment = 0;
        for (std::size_t i = 0; i < patch->points.size(); ++i) {
          const Eigen::Vector3d arm = X_WL * patch->points[i] - middle;
          moment += arm.cross(knot.forces.col(i)).z();
        }
        most = std::max(most, std::abs(moment));
      }
    }
    return most;
  }

  const models::RobotModel& robot_ = DrcHubo1();
  const NominalStance stance_ = SolveNominalStance(robot_, robot_.GaitNamed("walk"));
};

TEST_F(TurningPatternTest, TheSideThatHasSwungIsAheadAndTheTrunkTwistsBack) {
  const double turn = 0.15;
  const double twist = 0.2;
  const std::vector<Phase> motion = Motion(turn, twist);
  EXPECT_NEAR(YawOf("Body_TSY", motion.front().knots.front()), 0, 1e-9);
  EXPECT_NEAR(YawOf("Body_TSY", motion.back().knots.back()), 0, 1e-9);
  EXPECT_NEAR(YawOf("Body_Torso", motion.back().knots.back()), 0, 1e-9);
  int supports = 0;
  for (std::size_t i = 2; i + 2 < motion.size(); ++i) {
    if (motion[i].contacts.size() != 2) continue;
    ++supports;
    // In the middle of a double support the turn from one side to the other begins.
    const Knot& middle = motion[i].knots[motion[i].knots.size() / 2];
    const bool right_has_swung = motion[i - 1].contacts.front() == "left_sole";
    const double side = right_has_swung ? 1 : -1;
    EXPECT_NEAR(YawOf("Body_TSY", middle), side * turn, 1e-6);
    EXPECT_NEAR(YawOf("Body_Torso", middle), side * (turn - twist), 1e-6);
  }
  EXPECT_GE(supports, 2);
}

TEST_F(TurningPatternTest, StepsWithoutAShareDoNotTurn) {
  for (const Phase& phase : Motion(0.15, 0.2, 0)) {
    for (const Knot& knot : phase.knots) {
      EXPECT_NEAR(YawOf("Body_TSY", knot), 0, 1e-9);
      EXPECT_NEAR(YawOf("Body_Torso", knot), 0, 1e-9);
    }
  }
}

/// The angular momentum of the legs about the vertical goes into the trunk.
TEST_F(TurningPatternTest, ATrunkThatTwistsSparesTheFriction) {
  EXPECT_LT(TurningMoment(Motion(0, 0.15)), 0.9 * TurningMoment(Motion(0, 0)));
}

}  // namespace
}  // namespace possibility::actions
