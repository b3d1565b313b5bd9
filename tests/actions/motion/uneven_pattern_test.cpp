#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ostream>

#include "actions/motion/motion_schedule.h"
#include "actions/motion/pattern_motion.h"
#include "actions/verify/verifier.h"
#include "actions/wholebody/motion_builder.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

/// Stairs that DRC-HUBO1 walks up (or down), both feet on every tread or one.
struct StairCase {
  double rise = 0;   ///< m, of each of kSteps steps
  double tread = 0;  ///< m
  bool alternates = false;
  double swing = 1;  ///< s
};
constexpr int kSteps = 3;
/// From the middle of the soles on the last ground to the first edge, and so on, m.
constexpr double kToEdge = 0.13;

void PrintTo(const StairCase& stairs, std::ostream* stream) {
  *stream << fmt::format("{} m by {} m, {}", stairs.rise, stairs.tread,
                         stairs.alternates ? "alternating" : "both feet");
}

class UnevenPatternTest : public ::testing::TestWithParam<StairCase> {
 protected:
  UnevenPatternTest() {
    for (const models::GaitLimb& limb : stance_.gait->limbs) {
      schedule_.contacts.push_back(DrcHubo1().contacts[limb.contact].name);
    }
    standing_.bearing.resize(2);
    standing_.duration = 0.8;
    for (const int limb : {0, 1}) standing_.bearing[limb] = PoseOn(limb, 0);
    Add(standing_, 0);
    int foot = 0;
    for (int step = 1; step <= kSteps; ++step) {
      Move(foot, step);
      if (!GetParam().alternates || step == kSteps) Move(1 - foot, step);
      if (GetParam().alternates) foot = 1 - foot;
    }
    schedule_.intervals.back().duration = 0.8;
  }

  Eigen::Isometry3d PoseOn(int limb, int step) const {
    Eigen::Isometry3d X(Eigen::AngleAxisd(stance_.patch_headings[limb], Eigen::Vector3d::UnitZ()));
    X.translation() = stance_.patch_centres[limb] +
                      Eigen::Vector3d(step * GetParam().tread, 0, step * GetParam().rise);
    return X;
  }

  void Add(const models::ContactInterval& interval, double lift) {
    schedule_.intervals.push_back(interval);
    settings_.lifts.push_back(lift);
  }

  void Move(int limb, int step) {
    models::ContactInterval swing = standing_;
    swing.bearing[limb].reset();
    swing.duration = GetParam().swing;
    Add(swing, 0.02);
    standing_.bearing[limb] = PoseOn(limb, step);
    standing_.duration = 0.2;
    Add(standing_, 0);
  }

  std::vector<Phase> Motion() {
    settings_.clearance = 0.03;
    settings_.zmp_margin = 0.045;
    settings_.rise = 0.16;  // as high as the legs reach
    settings_.height_spacing = 0.16;
    settings_.rise_time = 0.8;
    settings_.filter_passes = 3;
    MotionSettings motion;
    motion.knot_spacing = 0.02;
    motion.minimum_intervals = 4;
    return MotionBuilder(DrcHubo1(), motion)
        .Build(PatternPhases(DrcHubo1(), stance_, schedule_, settings_), stance_.q);
  }

  testing::VerifierSubject Subject() {
    testing::VerifierSubject subject = testing::PlanWithoutMotion(DrcHubo1().file.string());
    models::Environment& environment = subject.scenario.environment;
    environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-9, -9), Eigen::Vector2d(9, 9));
    environment.obstacles.clear();
    for (int step = 0; step <= kSteps; ++step) {
      const bool is_end = step == 0 || step == kSteps;
      const double length = is_end ? 3 : GetParam().tread;
      const double front = step == 0 ? EdgeOf(1) - length : EdgeOf(step);
      environment.obstacles.push_back(TreadAt(front, length, step * GetParam().rise));
    }
    subject.scenario.goals[0].x = kSteps * GetParam().tread;
    subject.scenario.goals[0].z = kSteps * GetParam().rise;
    subject.plan.segments.push_back({"walk", Motion()});
    subject.plan.schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
    return subject;
  }

  double EdgeOf(int step) const {
    return stance_.patch_centres[0].x() + kToEdge + (step - 1) * GetParam().tread;
  }

  static models::Obstacle TreadAt(double front, double length, double top) {
    models::Obstacle tread;
    tread.name = fmt::format("tread at {:.2f}", front);
    tread.is_ground = true;
    tread.shape = models::Shape::Box({length, 2, 1});
    tread.X_WO.translation() << front + length / 2, 0, top - 0.5;
    return tread;
  }

  const NominalStance stance_ = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  models::ContactSchedule schedule_;
  models::ContactInterval standing_;
  PatternSettings settings_;
};

TEST_P(UnevenPatternTest, TheVerifierAcceptsTheMotionOnTheStairs) {
  const testing::VerifierSubject subject = Subject();
  const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
  for (const Violation& violation : report.violations) {
    ADD_FAILURE() << ToString(violation.kind) << ": " << violation.quantity << ", "
                  << violation.value << " (limit " << violation.limit << ") at " << violation.time;
  }
  EXPECT_TRUE(report.accepted());
}

TEST_P(UnevenPatternTest, EndsInTheNominalPostureOnTheLastTread) {
  Eigen::VectorXd end = stance_.q;
  end[4] += kSteps * GetParam().tread;
  end[6] += kSteps * GetParam().rise;
  const Knot last = Motion().back().knots.back();
  EXPECT_LT((last.q - end).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT(last.v.norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Stairs, UnevenPatternTest,
    ::testing::Values(StairCase{0.1, 0.26, true, 1.2}, StairCase{0.1, 0.3, false, 1},
                      StairCase{0.15, 0.24, false, 1}, StairCase{-0.1, 0.3, false, 1},
                      StairCase{-0.15, 0.26, false, 1}, StairCase{0.02, 0.3, true, 0.8}));

}  // namespace
}  // namespace possibility::actions
