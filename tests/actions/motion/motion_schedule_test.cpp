#include "actions/motion/motion_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>

#include "actions/plan/contact_name.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/verify/walk_and_crawl.h"

namespace possibility::actions {
namespace {

using testing::VerifierSubject;

/// Entry of a schedule for the contact of a phase.
const std::optional<Eigen::Isometry3d>& BearingOf(const models::ContactSchedule& schedule,
                                                  const models::ContactInterval& interval,
                                                  const std::string& contact) {
  const auto found = std::find(schedule.contacts.begin(), schedule.contacts.end(), contact);
  return interval.bearing.at(found - schedule.contacts.begin());
}

/// Checks the schedule against every knot of the motion by the world positions of points.
void ExpectFollowed(const models::ContactSchedule& schedule, const VerifierSubject& subject) {
  models::CheckContactSchedule(schedule);
  dynamics::TreeKinematics kinematics(subject.robot);
  std::size_t k = 0;
  double end = schedule.intervals[0].duration;
  for (const Segment& segment : subject.plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (phase.knots.front().t > end - 1e-9) end += schedule.intervals.at(++k).duration;
      EXPECT_LT(phase.knots.back().t, end + 1e-9);
      const models::ContactInterval& interval = schedule.intervals[k];
      EXPECT_EQ(std::count(interval.bearing.begin(), interval.bearing.end(), std::nullopt),
                schedule.contacts.size() - phase.contacts.size());
      for (const Knot& knot : phase.knots) {
        kinematics.SetPosition(knot.q);
        const std::vector<BearingPatch> patches = BearingPatches(subject.robot, phase);
        for (std::size_t i = 0; i < patches.size(); ++i) {
          const auto& pose = BearingOf(schedule, interval, phase.contacts[i]);
          ASSERT_TRUE(pose.has_value());
          const models::ContactPatch patch = PatchOf(subject.robot, patches[i]);
          const Eigen::Vector3d centre = kinematics.Position(patch.link, patch.Centre());
          EXPECT_LT((centre - pose->translation()).norm(), 1e-6);
        }
      }
    }
  }
  EXPECT_EQ(k + 1, schedule.intervals.size());
  EXPECT_NEAR(schedule.duration(), subject.plan.duration(), 1e-9);
}

TEST(MotionScheduleTest, HoldsWhenAndWhereContactsOfGaitsAndTransitionsBear) {
  const VerifierSubject& subject = testing::WalkAndCrawl();
  const models::ContactSchedule schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
  EXPECT_EQ(schedule.contacts.size(), 4u);
  ExpectFollowed(schedule, subject);
}

TEST(MotionScheduleTest, HasAnIntervalWithoutContactsForAFlight) {
  const VerifierSubject subject = testing::HopPlan(DrcHubo1().file.string());
  const models::ContactSchedule schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
  ExpectFollowed(schedule, subject);
  const auto flies = [](const models::ContactInterval& interval) {
    return std::count(interval.bearing.begin(), interval.bearing.end(), std::nullopt) ==
           static_cast<int>(interval.bearing.size());
  };
  EXPECT_EQ(std::count_if(schedule.intervals.begin(), schedule.intervals.end(), flies), 1);
}

TEST(MotionScheduleTest, SolesHaveTheirHeadingAndPointUp) {
  const VerifierSubject& subject = testing::WalkAndCrawl();
  const models::ContactSchedule schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
  for (const std::string sole : {"left_sole", "right_sole"}) {
    for (const models::ContactInterval& interval : schedule.intervals) {
      const auto& pose = BearingOf(schedule, interval, sole);
      if (!pose) continue;
      // The plan goes straight along x.
      EXPECT_LT((pose->linear() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
    }
  }
}

TEST(MotionScheduleTest, UnknownContactIsRefused) {
  VerifierSubject subject = testing::WalkAndCrawl();
  subject.plan.segments[0].phases[0].contacts[0] = "tail";
  EXPECT_THROW(ScheduleOfMotion(subject.robot, subject.plan.segments), InputError);
}

}  // namespace
}  // namespace possibility::actions
