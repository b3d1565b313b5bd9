#include "actions/gait/stepped_motion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "actions/wholebody/motion_error.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

constexpr double kWalked = 0.2;
constexpr double kStepped = 0.15;

const NominalStance& WalkingStance() { return DrcHubo1Locomotion().gaits[0]->stance; }

/// Walks, and steps with both feet onto ground that is `rise` higher.
SteppedMotion OntoGround(double rise) {
  SteppedMotion motion(DrcHubo1(), WalkingStance(), 1.5);
  motion.Walk(kWalked)
      .Shift({.over = 1, .lift = rise}, 1)
      .Swing(0, {.ahead = kStepped, .rise = rise}, {.over = 1, .lift = rise})
      .Shift({.over = 0}, 1)
      .Swing(1, {.ahead = kStepped, .rise = rise}, {.over = 0})
      .Rest(1);
  return motion;
}

class SteppedMotionTest : public ::testing::TestWithParam<double> {};

TEST_P(SteppedMotionTest, LeadsFromRestToRestInTheDisplacedNominalStance) {
  const SteppedMotion stepped = OntoGround(GetParam());
  const std::vector<Phase> motion = stepped.Build();
  const Knot& first = motion.front().knots.front();
  const Knot& last = motion.back().knots.back();
  Eigen::VectorXd displaced = WalkingStance().q;
  displaced[4] += kWalked + kStepped;
  displaced[6] += GetParam();
  EXPECT_LT((first.q - WalkingStance().q).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_LT((last.q - displaced).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_LT(first.v.norm() + last.v.norm(), 1e-9);
  EXPECT_NEAR(last.t, stepped.duration(), 1e-9);
}

TEST_P(SteppedMotionTest, PatchesThatBearStayWhereTheyAre) {
  const models::RobotModel& robot = DrcHubo1();
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : OntoGround(GetParam()).Build()) {
    for (const models::ContactPatch& patch : robot.contacts) {
      if (std::find(phase.contacts.begin(), phase.contacts.end(), patch.name) ==
          phase.contacts.end()) {
        continue;
      }
      for (const Eigen::Vector3d& p : patch.points) {
        kinematics.SetPosition(phase.knots.front().q);
        const Eigen::Vector3d before = kinematics.Position(patch.link, p);
        for (const Knot& knot : phase.knots) {
          kinematics.SetPosition(knot.q);
          EXPECT_LT((kinematics.Position(patch.link, p) - before).norm(), 1e-9);
        }
      }
    }
  }
}

/// Hermite's quadrature: the integral of v from its ends and their derivatives, to fifth order.
TEST_P(SteppedMotionTest, JointsMoveByTheIntegralOfTheirVelocities) {
  const int n = DrcHubo1().num_joints();
  for (const Phase& phase : OntoGround(GetParam()).Build()) {
    for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      const Knot& a = phase.knots[i];
      const Knot& b = phase.knots[i + 1];
      const double h = b.t - a.t;
      const Eigen::VectorXd integral = h / 2 * (a.v + b.v) + h * h / 12 * (a.a - b.a);
      const double error = ((b.q - a.q).tail(n) - integral.tail(n)).lpNorm<Eigen::Infinity>();
      EXPECT_LT(error, 1e-4) << "at " << a.t << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rises, SteppedMotionTest, ::testing::Values(0.0, 0.04, 0.08));

TEST(SteppedMotionLimits, AStepOutOfReachNamesTheLimit) {
  try {
    OntoGround(0.5).Build();
    FAIL() << "half a metre is too high";
  } catch (const MotionError& error) {
    EXPECT_FALSE(std::string(error.what()).empty());
  }
}

TEST(SteppedMotionLimits, ACancelledBuildEnds) {
  const CancellationToken cancelled([] { return false; });
  EXPECT_THROW(OntoGround(0.05).Build(cancelled), Cancelled);
}

}  // namespace
}  // namespace possibility::actions
