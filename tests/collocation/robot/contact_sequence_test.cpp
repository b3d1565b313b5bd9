#include "collocation/robot/contact_sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>

#include "tests/dynamics/random_robot.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

Eigen::Isometry3d At2D(double x, double y) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, 0));
}

/// Both feet, the left one swings, both feet again.
models::ContactSchedule LeftStep() {
  const Eigen::Isometry3d left = At2D(0, 0.09);
  const Eigen::Isometry3d ahead = At2D(0.2, 0.09);
  const Eigen::Isometry3d right = At2D(0, -0.09);
  models::ContactSchedule schedule;
  schedule.contacts = {"left_sole", "right_sole"};
  schedule.intervals = {{0.4, {left, right}}, {0.6, {std::nullopt, right}}, {0.5, {ahead, right}}};
  return schedule;
}

class ContactSequenceTest : public ::testing::Test {
 protected:
  const Phase::PathConstraint* Find(int phase, const std::string& name) const {
    const auto& constraints = problem_.phase(phase).constraints();
    const auto found = std::find_if(constraints.begin(), constraints.end(),
                                    [&](const auto& c) { return c.name == name; });
    return found == constraints.end() ? nullptr : &*found;
  }

  /// Bounds of a force at one end of a phase.
  bool IsZero(const RobotPhase& robot, int force, At at) const {
    for (const auto& [where, bounds] : robot.phase->Find(robot.f[force]).bounds) {
      if (where == at && bounds.lower == 0 && bounds.upper == 0) return true;
    }
    return false;
  }

  RobotSystem model_ = dynamics::MultibodyModel::OnJoints(dynamics::DrcHubo());
  OptimalControlProblem problem_{"step"};
  ContactSequenceSettings settings_;
};

TEST_F(ContactSequenceTest, HasAPhaseForEachIntervalWithItsContactsAndDurations) {
  settings_.quickest = 0.5;
  settings_.slowest = 3;
  const auto phases = AddContactSequence(&problem_, model_, LeftStep(), settings_);
  ASSERT_EQ(phases.size(), 3U);
  const int points[] = {8, 4, 8};
  const double durations[] = {0.4, 0.6, 0.5};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(phases[k].points.size(), points[k]);
    EXPECT_DOUBLE_EQ(problem_.phase(k).duration_bounds().lower, 0.5 * durations[k]);
    EXPECT_DOUBLE_EQ(problem_.phase(k).duration_bounds().upper, 3 * durations[k]);
  }
  EXPECT_EQ(problem_.continued().size(), 4U * model_->nv());
}

TEST_F(ContactSequenceTest, OnlyAFootThatSwingsHasAClearance) {
  AddContactSequence(&problem_, model_, LeftStep(), settings_);
  EXPECT_NE(Find(1, "clearance of left_sole"), nullptr);
  for (const int k : {0, 1, 2}) EXPECT_EQ(Find(k, "clearance of right_sole"), nullptr);
  EXPECT_EQ(Find(1, "velocity of left_sole"), nullptr);
  EXPECT_NE(Find(1, "velocity of right_sole"), nullptr);
}

TEST_F(ContactSequenceTest, AFootBearsNothingWhereItLiftsAndLands) {
  const auto phases = AddContactSequence(&problem_, model_, LeftStep(), settings_);
  for (int force = 0; force < 12; ++force) {
    EXPECT_TRUE(IsZero(phases[0], force, At::kEnd));    // left, about to lift
    EXPECT_TRUE(IsZero(phases[2], force, At::kStart));  // left, just landed
    EXPECT_FALSE(IsZero(phases[0], 12 + force, At::kEnd));
    EXPECT_FALSE(IsZero(phases[2], 12 + force, At::kStart));
  }
}

TEST_F(ContactSequenceTest, PlacesAreStatedWhereNoFixedEndImpliesThem) {
  AddContactSequence(&problem_, model_, LeftStep(), settings_);
  // Bears to the end, which is fixed.
  EXPECT_EQ(Find(2, "place of left_sole"), nullptr);
  OptimalControlProblem open("open end");
  settings_.end_is_fixed = false;
  const auto phases = AddContactSequence(&open, model_, LeftStep(), settings_);
  const auto& constraints = phases[2].phase->constraints();
  EXPECT_TRUE(std::any_of(constraints.begin(), constraints.end(), [](const auto& c) {
    return c.name == "place of left_sole" && c.at == At::kStart;
  }));
}

TEST_F(ContactSequenceTest, SeparationsHoldInTheirInterval) {
  settings_.separations = {{{{7, {0, 0, 0}}, {8, {0, 0, 0}}, Eigen::Vector3d::UnitX()}, 0.05, 1}};
  AddContactSequence(&problem_, model_, LeftStep(), settings_);
  EXPECT_EQ(Find(0, "separation"), nullptr);
  ASSERT_NE(Find(1, "separation"), nullptr);
  EXPECT_DOUBLE_EQ(Find(1, "separation")->bounds.front().lower, 0.05);
  EXPECT_EQ(Find(2, "separation"), nullptr);
}

TEST_F(ContactSequenceTest, AnUnknownContactIsNamed) {
  models::ContactSchedule schedule = LeftStep();
  schedule.contacts[1] = "tail";
  EXPECT_EQ(MessageOf([&] { AddContactSequence(&problem_, model_, schedule, settings_); }),
            "contact sequence: the robot has no contact 'tail'");
}

TEST_F(ContactSequenceTest, ABrokenScheduleIsRefused) {
  models::ContactSchedule schedule = LeftStep();
  schedule.intervals[1].duration = 0;
  EXPECT_EQ(MessageOf([&] { AddContactSequence(&problem_, model_, schedule, settings_); }),
            "contact schedule: interval 1 lasts 0 s, expected more than 0");
}

}  // namespace
}  // namespace possibility::collocation
