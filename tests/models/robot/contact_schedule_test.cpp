#include "models/robot/contact_schedule.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <string>

#include "tests/message_of.h"

namespace possibility::models {
namespace {

Eigen::Isometry3d Place(double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); }

/// Two limbs: the first steps from 0 to 1, then the second from 2 to 3 in two intervals.
ContactSchedule TwoSteps() {
  ContactSchedule schedule;
  schedule.contacts = {"left", "right"};
  schedule.intervals = {{0.5, {Place(0), Place(2)}},       {0.25, {std::nullopt, Place(2)}},
                        {0.125, {Place(1), Place(2)}},     {0.25, {Place(1), std::nullopt}},
                        {0.375, {Place(1), std::nullopt}}, {0.5, {Place(1), Place(3)}}};
  return schedule;
}

std::string FaultOf(const ContactSchedule& schedule) {
  return MessageOf([&] { CheckContactSchedule(schedule); });
}

TEST(ContactScheduleTest, DurationIsTheSumOfTheIntervals) {
  EXPECT_DOUBLE_EQ(TwoSteps().duration(), 2);
  EXPECT_DOUBLE_EQ(ContactSchedule().duration(), 0);
}

TEST(ContactScheduleTest, SwingLeadsFromTheLastPlaceToTheNext) {
  const ContactSchedule schedule = TwoSteps();
  EXPECT_EQ(schedule.Before(1, 0).translation().x(), 0);
  EXPECT_EQ(schedule.After(1, 0).translation().x(), 1);
  for (const int k : {3, 4}) {
    EXPECT_EQ(schedule.Before(k, 1).translation().x(), 2);
    EXPECT_EQ(schedule.After(k, 1).translation().x(), 3);
  }
}

TEST(ContactScheduleTest, BearingLimbIsBeforeAndAfterWhereItBears) {
  const ContactSchedule schedule = TwoSteps();
  for (const int k : {0, 2, 5}) {
    for (const int limb : {0, 1}) {
      EXPECT_EQ(&schedule.Before(k, limb), &*schedule.intervals[k].bearing[limb]);
      EXPECT_EQ(&schedule.After(k, limb), &*schedule.intervals[k].bearing[limb]);
    }
  }
}

TEST(ContactScheduleTest, AsDescribedIsAccepted) { EXPECT_EQ(FaultOf(TwoSteps()), "no error"); }

TEST(ContactScheduleTest, WithoutIntervalsIsRefused) {
  EXPECT_EQ(FaultOf({{"left"}, {}}), "contact schedule: no intervals");
}

TEST(ContactScheduleTest, WithoutContactsIsRefused) {
  EXPECT_EQ(FaultOf({}), "contact schedule: no contacts");
}

TEST(ContactScheduleTest, ContactListedTwiceIsRefused) {
  ContactSchedule schedule = TwoSteps();
  schedule.contacts = {"left", "left"};
  EXPECT_EQ(FaultOf(schedule), "contact schedule: left is listed twice");
}

TEST(ContactScheduleTest, DurationThatIsNotPositiveIsRefusedByInterval) {
  for (const double duration : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()}) {
    ContactSchedule schedule = TwoSteps();
    schedule.intervals[3].duration = duration;
    EXPECT_NE(FaultOf(schedule).find("interval 3 lasts"), std::string::npos) << FaultOf(schedule);
  }
}

TEST(ContactScheduleTest, OtherNumberOfEntriesIsRefusedByInterval) {
  ContactSchedule schedule = TwoSteps();
  schedule.intervals[2].bearing.push_back(Place(5));
  EXPECT_EQ(FaultOf(schedule),
            "contact schedule: interval 2 has 3 entries, expected 2, one per contact");
  schedule.intervals[2].bearing.resize(1);
  EXPECT_EQ(FaultOf(schedule),
            "contact schedule: interval 2 has 1 entries, expected 2, one per contact");
}

TEST(ContactScheduleTest, ContactThatMovesWhileItBearsIsRefusedByNameAndInterval) {
  ContactSchedule schedule = TwoSteps();
  schedule.intervals[2].bearing[1] = Place(2.001);
  EXPECT_EQ(FaultOf(schedule),
            "contact schedule: right moves at the start of interval 2 without a swing");
  schedule = TwoSteps();
  schedule.intervals[3].bearing[0]->rotate(Eigen::AngleAxisd(0.001, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(FaultOf(schedule),
            "contact schedule: left moves at the start of interval 3 without a swing");
}

}  // namespace
}  // namespace possibility::models
