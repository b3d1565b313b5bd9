#include "actions/motion/pattern_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "actions/gait/foothold_plan.h"
#include "actions/motion/motion_schedule.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/support_polygon.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "tests/actions/drchubo1.h"
#include "tests/message_of.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const StepBounds kBounds = {0.28, 0.25, 0.4};
const StepTiming kTiming = {0.45, 0.28, 0.06, 0.35};

struct WayCase {
  std::string name;
  PlanarPose way;
  double rise = 0;  ///< m
};

void PrintTo(const WayCase& way_case, std::ostream* stream) { *stream << way_case.name; }

/// Walking of DRC-HUBO1 from one stance to another.
class PatternMotionTest : public ::testing::TestWithParam<WayCase> {
 protected:
  PlanarPose goal() const { return start_ * GetParam().way; }

  models::ContactSchedule Schedule(const StepBounds& bounds = kBounds) const {
    const auto groups = SwingGroups(stance_);
    return ScheduleOf(robot_, stance_, groups, start_,
                      PlanSteps(stance_, groups, {start_, goal()}, bounds), kTiming);
  }

  std::vector<MotionPhase> Phases(int filter_passes = 2, int coarse_stride = 1) const {
    PatternSettings settings;
    settings.filter_passes = filter_passes;
    settings.coarse_stride = coarse_stride;
    settings.rise = GetParam().rise;
    return PatternPhases(robot_, stance_, Schedule(), settings);
  }

  /// The posture with its wrists turned, which walking does not use.
  VectorXd TurnedWrists() const {
    VectorXd joints = stance_.q.tail(robot_.num_joints());
    for (const char* wrist : {"LWP", "RWP"}) {
      joints[robot_.JointIndex(wrist)] -= 0.5;
    }
    return joints;
  }

  VectorXd Guess() const {
    VectorXd q = stance_.q;
    q.segment<2>(4) = start_.position();
    return q;
  }

  std::vector<Phase> Motion() const {
    MotionSettings settings;
    settings.minimum_intervals = 6;
    settings.knot_spacing = 0.03;
    return MotionBuilder(robot_, settings).Build(Phases(), Guess());
  }

  /// Corners of the patches that bear, in the order of Knot::forces.
  std::vector<Vector3d> BearingPoints(const Phase& phase, const VectorXd& q) {
    kinematics_.SetPosition(q);
    std::vector<Vector3d> points;
    for (const std::string& name : phase.contacts) {
      const models::ContactPatch& patch = robot_.contacts[robot_.ContactIndex(name)];
      for (const Vector3d& p : patch.points) points.push_back(kinematics_.Position(patch.link, p));
    }
    return points;
  }

  const models::RobotModel& robot_ = DrcHubo1();
  const NominalStance stance_ = SolveNominalStance(robot_, robot_.GaitNamed("walk"));
  const PlanarPose start_{0.4, -0.3, 0.8};
  dynamics::TreeKinematics kinematics_{robot_};
};

TEST_P(PatternMotionTest, CentreOfPressureStaysTwoCentimetresInsideTheSupport) {
  double least = std::numeric_limits<double>::infinity();
  for (const Phase& phase : Motion()) {
    for (const Knot& knot : phase.knots) {
      const std::vector<Vector3d> points = BearingPoints(phase, knot.q);
      ASSERT_EQ(static_cast<int>(points.size()), knot.forces.cols());
      Vector2d moment = Vector2d::Zero();
      std::vector<Vector2d> support;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points[i].z(), 0, 1e-8);
        support.push_back(points[i].head<2>());
        moment += knot.forces(2, static_cast<int>(i)) * support.back();
      }
      const Vector2d centre = moment / knot.forces.row(2).sum();
      least = std::min(least, SupportPolygon(support).Margin(centre));
    }
  }
  RecordProperty("least_margin_mm", static_cast<int>(1000 * least));
  EXPECT_GT(least, 0.02);
}

TEST_P(PatternMotionTest, MotionFollowsTheSchedule) {
  const models::ContactSchedule schedule = Schedule();
  const models::ContactSchedule followed = ScheduleOfMotion(robot_, {{"walk", Motion()}});
  EXPECT_EQ(followed.contacts, schedule.contacts);
  ASSERT_EQ(followed.intervals.size(), schedule.intervals.size());
  for (std::size_t k = 0; k < schedule.intervals.size(); ++k) {
    EXPECT_NEAR(followed.intervals[k].duration, schedule.intervals[k].duration, 1e-9);
    for (std::size_t limb = 0; limb < schedule.contacts.size(); ++limb) {
      const auto& pose = followed.intervals[k].bearing[limb];
      const auto& planned = schedule.intervals[k].bearing[limb];
      ASSERT_EQ(pose.has_value(), planned.has_value());
      if (!pose) continue;
      EXPECT_LT((pose->matrix() - planned->matrix()).norm(), 1e-6);
    }
  }
}

TEST_P(PatternMotionTest, BeginsAndEndsAtRestInTheNominalPosture) {
  const std::vector<Phase> motion = Motion();
  for (const bool begins : {true, false}) {
    const Knot& knot = begins ? motion.front().knots.front() : motion.back().knots.back();
    const PlanarPose at = begins ? start_ : goal();
    const Eigen::Isometry3d X_WR = stance_.RootPose(at, 0);
    const Eigen::Quaterniond orientation(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
    EXPECT_LT(orientation.angularDistance(Eigen::Quaterniond(X_WR.linear())), 1e-6);
    EXPECT_LT((knot.q.segment<3>(4) - X_WR.translation()).norm(), 1e-6);
    EXPECT_LT((knot.q.tail(robot_.num_joints()) - stance_.q.tail(robot_.num_joints())).norm(),
              1e-6);
    EXPECT_LT(knot.v.norm(), 1e-6);
  }
}

TEST_P(PatternMotionTest, EndsAtRestInTheStanceWithOtherJointsTurned) {
  PatternSettings settings;
  settings.rise = GetParam().rise;
  settings.end_joints = TurnedWrists();
  settings.turning_time = 0.8;
  const std::vector<Phase> motion =
      MotionBuilder(robot_).Build(PatternPhases(robot_, stance_, Schedule(), settings), Guess());
  const Knot& first = motion.front().knots.front();
  const Knot& last = motion.back().knots.back();
  const Eigen::Isometry3d X_WR = stance_.RootPose(goal(), 0);
  EXPECT_LT((first.q.tail(robot_.num_joints()) - stance_.q.tail(robot_.num_joints())).norm(), 1e-6);
  EXPECT_LT((last.q.segment<3>(4) - X_WR.translation()).norm(), 1e-6);
  EXPECT_LT((last.q.tail(robot_.num_joints()) - settings.end_joints).norm(), 1e-6);
  EXPECT_LT(last.v.norm(), 1e-6);
  EXPECT_LT(last.a.norm(), 1e-6);
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      if (last.t - knot.t < settings.turning_time) continue;
      EXPECT_LT(
          (knot.q - first.q).segment(7 + robot_.JointIndex("LWP"), 1).lpNorm<Eigen::Infinity>(),
          1e-9)
          << knot.t;
    }
  }
}

TEST_P(PatternMotionTest, TheRootRisesAndComesDownAgain) {
  const double stand = stance_.gait->posture.root_height;
  double highest = 0;
  for (const Phase& phase : Motion()) {
    for (const Knot& knot : phase.knots) {
      EXPECT_GT(knot.q[6], stand - 1e-6);
      highest = std::max(highest, knot.q[6]);
    }
  }
  EXPECT_NEAR(highest, stand + GetParam().rise, 1e-6);
}

TEST_P(PatternMotionTest, StateAndAccelerationsAreContinuousWhereContactsChange) {
  const std::vector<Phase> motion = Motion();
  double largest = 0;
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) largest = std::max(largest, knot.a.cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
    const Knot& before = motion[i].knots.back();
    const Knot& after = motion[i + 1].knots.front();
    EXPECT_NEAR(before.t, after.t, 1e-12);
    EXPECT_LT((before.q - after.q).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_LT((before.v - after.v).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((before.a - after.a).cwiseAbs().maxCoeff(), 1e-6 * largest);
  }
}

TEST_P(PatternMotionTest, VelocityAndAccelerationAreTheDerivativesOfPosition) {
  constexpr double kShort = 1e-5;
  WholeBodySolver solver(robot_);
  VectorXd q = Guess();
  for (const MotionPhase& phase : Phases()) {
    for (const double share : {0.27, 0.71}) {
      const double t = share * phase.duration;
      const WholeBodyState now = solver.Solve(phase.task(t), q);
      const WholeBodyState before = solver.Solve(phase.task(t - kShort), now.q);
      const WholeBodyState after = solver.Solve(phase.task(t + kShort), now.q);
      q = now.q;
      const int n = robot_.num_joints() + 3;
      EXPECT_LT(((after.q - before.q).tail(n) / (2 * kShort) - now.v.tail(n)).norm(), 1e-4);
      EXPECT_LT(((after.v - before.v) / (2 * kShort) - now.a).norm(), 1e-2);
    }
  }
}

TEST_P(PatternMotionTest, AGuessErrsByTheThirdOrderOfTime) {
  constexpr double kTime = 0.01;  // s
  WholeBodySolver solver(robot_);
  VectorXd q = Guess();
  for (const MotionPhase& phase : Phases()) {
    const double t = 0.4 * phase.duration;
    const WholeBodyState now = solver.Solve(phase.task(t), q);
    q = now.q;
    const auto error = [&](double time) {
      const WholeBodyState later = solver.Solve(phase.task(t + time), q);
      return (GuessAfter(now, time) - later.q).tail(robot_.num_joints() + 3).norm();
    };
    EXPECT_LT(error(kTime / 2), error(kTime) / 6 + 1e-9);
    EXPECT_LT(error(kTime), 1e-3);
  }
}

TEST_P(PatternMotionTest, BearingPatchesDoNotMove) {
  std::vector<Vector3d> stood;
  for (const Phase& phase : Motion()) {
    const std::vector<Vector3d> places = BearingPoints(phase, phase.knots.front().q);
    for (const Knot& knot : phase.knots) {
      const std::vector<Vector3d> points = BearingPoints(phase, knot.q);
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT((points[i] - places[i]).norm(), 1e-8);
      }
    }
    // Soles that bore before or bear now: the fewer of them are among the others.
    for (const Vector3d& p : places.size() < stood.size() ? places : stood) {
      const auto& others = places.size() < stood.size() ? stood : places;
      EXPECT_TRUE(std::any_of(others.begin(), others.end(),
                              [&](const Vector3d& other) { return (p - other).norm() < 1e-8; }));
    }
    stood = places;
  }
}

/// Greatest distance that the zero moment point moves while a foot swings, by Simbody.
double ZmpTravel(const models::RobotModel& robot, const std::vector<MotionPhase>& phases,
                 VectorXd q) {
  WholeBodySolver solver(robot);
  dynamics::SimbodyDynamics simbody(robot);
  double travel = 0;
  for (const MotionPhase& phase : phases) {
    Eigen::AlignedBox2d reached;
    for (double t = 0; t <= phase.duration; t += phase.duration / 16) {
      const WholeBodyState state = solver.Solve(phase.task(t), q);
      q = state.q;
      simbody.SetState(state.q, state.v);
      const VectorXd root = simbody.InverseDynamics(state.a).head<6>();
      const Vector3d moment = root.head<3>() + state.q.segment<3>(4).cross(root.tail<3>());
      reached.extend(Vector2d(-moment.y(), moment.x()) / root[5]);
    }
    if (phase.contacts.size() == 1) travel = std::max(travel, reached.sizes().maxCoeff());
  }
  return travel;
}

TEST_P(PatternMotionTest, EachFilterPassHoldsTheZeroMomentPointMoreStillDuringSwings) {
  const double without = ZmpTravel(robot_, Phases(0), Guess());
  const double once = ZmpTravel(robot_, Phases(1), Guess());
  const double twice = ZmpTravel(robot_, Phases(2), Guess());
  RecordProperty("travel_without_mm", static_cast<int>(1000 * without));
  RecordProperty("travel_once_mm", static_cast<int>(1000 * once));
  RecordProperty("travel_twice_mm", static_cast<int>(1000 * twice));
  EXPECT_LT(once, without / 2);
  EXPECT_LT(twice, once / 2);
  EXPECT_LT(twice, 0.2 * without);
}

TEST_P(PatternMotionTest, CoarsePassesBeforeTheLastHoldTheZeroMomentPointAboutAsStill) {
  const double coarse = ZmpTravel(robot_, Phases(3, 4), Guess());
  RecordProperty("travel_mm", static_cast<int>(1000 * coarse));
  EXPECT_LT(coarse, ZmpTravel(robot_, Phases(1), Guess()) / 2);
  EXPECT_LT(coarse, 1.5 * ZmpTravel(robot_, Phases(2), Guess()));
}

INSTANTIATE_TEST_SUITE_P(Ways, PatternMotionTest,
                         ::testing::Values(WayCase{"ahead", {1.2, 0, 0}},
                                           WayCase{"bend", {0.9, 0.1, 0.5}},
                                           WayCase{"aside", {0, 0.6, 0}},
                                           WayCase{"high", {1.2, 0, 0}, 0.09}),
                         [](const auto& info) { return info.param.name; });

using PatternMotionRefusals = PatternMotionTest;

TEST_P(PatternMotionRefusals, StepOutOfReachIsRefused) {
  EXPECT_THROW(PatternPhases(robot_, stance_, Schedule({1.5, 0.25, 0.4}), {}), MotionError);
}

TEST_P(PatternMotionRefusals, NoScheduleIsRefused) {
  EXPECT_THROW(PatternPhases(robot_, stance_, {}, {}), std::invalid_argument);
}

TEST_P(PatternMotionRefusals, ScheduleOfOtherContactsIsRefused) {
  models::ContactSchedule schedule = Schedule();
  schedule.contacts.front() = "tail";
  const std::string message = MessageOf([&] { PatternPhases(robot_, stance_, schedule, {}); });
  EXPECT_NE(message.find("contact schedule of tail, "), std::string::npos) << message;
}

TEST_P(PatternMotionRefusals, SwingInTheFirstOrTheLastIntervalIsRefused) {
  for (const bool first : {true, false}) {
    models::ContactSchedule schedule = Schedule();
    models::ContactInterval& end = first ? schedule.intervals.front() : schedule.intervals.back();
    end.bearing[1].reset();
    EXPECT_EQ(MessageOf([&] { PatternPhases(robot_, stance_, schedule, {}); }),
              "contact schedule: a limb swings in the first or the last interval");
  }
}

TEST_P(PatternMotionRefusals, CancellationEndsTheWork) {
  const CancellationToken cancelled([] { return false; });
  EXPECT_THROW(PatternPhases(robot_, stance_, Schedule(), {}, cancelled), Cancelled);
}

INSTANTIATE_TEST_SUITE_P(Ways, PatternMotionRefusals, ::testing::Values(WayCase{"far", {3, 0, 0}}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace possibility::actions
