#include "actions/rollout/step_feedback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "actions/rollout/perturbed_rollouts.h"
#include "models/robot/rotation_vector.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

const Vector3d kUp = Vector3d::UnitZ();

/// A walk ahead, and its feedback.
class StepFeedbackTest : public ::testing::Test {
 protected:
  Knot KnotAt(double t) const {
    for (const Phase& phase : segment_.phases) {
      for (const Knot& knot : phase.knots) {
        if (knot.t > t - 1e-9) return knot;
      }
    }
    return segment_.phases.back().knots.back();
  }

  /// Lets the robot look at the same tilt all through the swing of tick `first`.
  void SenseSwing(StepFeedback* steps, double first, const RootTilt& tilt) const {
    const double land = steps->LandingAfter(first);
    for (const double t : steps->ticks()) {
      if (steps->LandingAfter(t) != land) continue;
      steps->Sense(t, tilt, KnotAt(land).q, kUp);
    }
  }

  /// The feet at q, left first, as poses of their patches' centres in the world.
  std::vector<Isometry3d> Feet(const VectorXd& q) {
    kinematics_.SetPosition(q);
    std::vector<Isometry3d> feet;
    for (const char* name : {"left_sole", "right_sole"}) {
      const models::ContactPatch& patch = robot_.contacts[robot_.ContactIndex(name)];
      feet.push_back(kinematics_.X_WL()[patch.link] * Eigen::Translation3d(patch.Centre()));
    }
    return feet;
  }

  /// The robot at landing time, tipped by `tilt` about the ground below its root, with corrected
  /// joints.
  VectorXd Tipped(const StepFeedback& steps, double land, const Vector3d& tilt) const {
    VectorXd q = KnotAt(land).q;
    if (const auto correction = steps.CorrectionAt(land, q)) {
      q.tail(robot_.num_joints()) += correction->position;
    }
    const Eigen::Quaterniond turned =
        Eigen::Quaterniond(models::Exponential(tilt)) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    q.head<4>() << turned.w(), turned.vec();
    const Vector3d pivot(q[4], q[5], 0);
    q.segment<3>(4) = pivot + models::Exponential(tilt) * Vector3d(0, 0, q[6]);
    return q;
  }

  const models::RobotModel& robot_ = DrcHubo1();
  models::Scenario scenario_ = testing::FlatScenario();
  Plan plan_ = WalkTo({1.5, 0, 0}, scenario_);
  const Segment& segment_ = plan_.segments.front();
  dynamics::TreeKinematics kinematics_{robot_};
};

TEST_F(StepFeedbackTest, LooksOnlyWhileAFootSwings) {
  const StepFeedback steps(segment_, robot_);
  ASSERT_FALSE(steps.ticks().empty());
  EXPECT_TRUE(std::is_sorted(steps.ticks().begin(), steps.ticks().end()));
  for (const double t : steps.ticks()) {
    const auto phase = std::find_if(segment_.phases.begin(), segment_.phases.end(),
                                    [t](const Phase& p) { return p.knots.back().t > t; });
    EXPECT_EQ(phase->contacts.size(), 1u) << t;
    EXPECT_NEAR(phase->knots.back().t, steps.LandingAfter(t), 1e-9);
  }
}

TEST_F(StepFeedbackTest, LeavesCrawlingAlone) {
  const FlowingGait& crawl = DrcHubo1Flowing("crawl");
  const Segment crawling = {
      "crawl",
      crawl.motion().Motion(StridesThrough(crawl.parameters(), {{}, {0.5, 0, 0}}), 0.1, {})};
  EXPECT_TRUE(StepFeedback(crawling, robot_).ticks().empty());
}

TEST_F(StepFeedbackTest, ARobotThatDoesNotTipIsNotCorrected) {
  StepFeedback steps(segment_, robot_);
  for (const double t : steps.ticks()) {
    steps.Sense(t, {{0.004, -0.003, 0}, {0.01, 0.01, 0}}, KnotAt(steps.LandingAfter(t)).q, kUp);
    const auto correction = steps.CorrectionAt(t + 0.05, KnotAt(t).q);
    EXPECT_FALSE(correction);
  }
}

TEST_F(StepFeedbackTest, FeetOfATippedRobotComeDownFlatOnTheGround) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> angle(-0.06, 0.06);
  const std::vector<double> ticks = StepFeedback(segment_, robot_).ticks();
  for (int trial = 0; trial < 40; ++trial) {
    StepFeedback steps(segment_, robot_);
    const double t = ticks[generator() % ticks.size()];
    const double land = steps.LandingAfter(t);
    const Vector3d tilt(angle(generator), angle(generator), 0);
    SenseSwing(&steps, t, {tilt, Vector3d::Zero()});
    const std::vector<Isometry3d> planned = Feet(KnotAt(land).q);
    const std::vector<Isometry3d> rigid = Feet(Tipped(StepFeedback(segment_, robot_), land, tilt));
    const std::vector<Isometry3d> feet = Feet(Tipped(steps, land, tilt));
    const bool left_swings = (feet[0].translation() - rigid[0].translation()).norm() >
                             (feet[1].translation() - rigid[1].translation()).norm();
    const int swings = left_swings ? 0 : 1;
    const auto tipping = [&](const Isometry3d& X) {
      return models::RotationVector(
                 Eigen::Matrix3d(X.linear() * planned[swings].linear().transpose()))
          .norm();
    };
    // Tilts below 0.01 rad count as none; the rest is of second order.
    EXPECT_LT(tipping(feet[swings]), 0.01 + 0.3 * tilt.squaredNorm() + 0.004) << trial;
    EXPECT_LT(std::abs(feet[swings].translation().z()), 0.006) << trial;
  }
}

TEST_F(StepFeedbackTest, FeetGoWhereTheRobotTipsAndStayApart) {
  for (const double rate : {-0.8, -0.3, 0.3, 0.8}) {
    for (const bool sideways : {false, true}) {
      // Tipping forwards turns about +y, tipping to the left about -x.
      const RootTilt tilt = {Vector3d::Zero(),
                             sideways ? Vector3d(-rate, 0, 0) : Vector3d(0, rate, 0)};
      StepFeedback steps(segment_, robot_);
      const double t = steps.ticks()[steps.ticks().size() / 2];
      SenseSwing(&steps, t, tilt);
      const double land = steps.LandingAfter(t);
      const std::vector<Isometry3d> planned = Feet(KnotAt(land).q);
      const double left = land - steps.ticks()[steps.ticks().size() / 2];
      const std::vector<Isometry3d> feet = Feet(Tipped(steps, land, left * tilt.rate));
      const int axis = sideways ? 1 : 0;
      const Vector3d moved[] = {feet[0].translation() - planned[0].translation(),
                                feet[1].translation() - planned[1].translation()};
      const double step =
          std::abs(moved[0][axis]) > std::abs(moved[1][axis]) ? moved[0][axis] : moved[1][axis];
      if (!sideways) {
        EXPECT_GT(step * rate, 0) << rate;
      }
      const auto& patch = robot_.contacts[robot_.ContactIndex("left_sole")];
      const double width = patch.points[0].y() - patch.points[2].y();
      const double length = patch.points[0].x() - patch.points[2].x();
      const Vector3d apart = feet[0].translation() - feet[1].translation();
      EXPECT_TRUE(apart.y() > width || std::abs(apart.x()) > length) << rate;
    }
  }
}

TEST_F(StepFeedbackTest, DisplacementsDieOutAfterTheLanding) {
  StepFeedback steps(segment_, robot_);
  const double t = steps.ticks().front();
  const double land = steps.LandingAfter(t);
  SenseSwing(&steps, t, {Vector3d(0, 0.05, 0), Vector3d(0, 0.4, 0)});
  const VectorXd q = KnotAt(land).q;
  const double at_landing = steps.CorrectionAt(land, q)->position.norm();
  EXPECT_GT(at_landing, 0.02);
  double before = at_landing;
  for (double later = 0.1; later < 1.2; later += 0.1) {
    const JointCorrection correction = *steps.CorrectionAt(land + later, q);
    EXPECT_LT(correction.position.norm(), before);
    before = correction.position.norm();
    const double h = 1e-3;
    const VectorXd difference = (steps.CorrectionAt(land + later + h, q)->position -
                                 steps.CorrectionAt(land + later - h, q)->position) /
                                (2 * h);
    EXPECT_LT((correction.velocity - difference).norm(), 1e-4 * at_landing);
  }
  EXPECT_LT(before, 0.05 * at_landing);
}

TEST_F(StepFeedbackTest, PushedWalkersStayUpright) {
  std::vector<Perturbation> pushes;
  for (const double direction : {0.0, 0.5, 1.0, -0.5}) {
    Perturbation& push = pushes.emplace_back();
    push.push = 10;
    push.push_direction = direction * std::numbers::pi;
  }
  for (const PerturbedRollout& rollout : RollOutPerturbed(
           plan_, robot_, scenario_, pushes, {.threads = 2, .cancellation = {}, .progress = {}})) {
    EXPECT_TRUE(rollout.survives()) << rollout.perturbation.push_direction;
  }
}

}  // namespace
}  // namespace possibility::actions
