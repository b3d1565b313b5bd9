#include "experiments/trials/trial_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/experiments/sample_plan.h"
#include "tests/experiments/trials/sample_records.h"

namespace possibility::experiments {
namespace {

using testing::FailedRecord;
using testing::SampleRecord;
using testing::SweepRecord;

TEST(TrialRecord, ReadsBackToTheSame) {
  for (const TrialRecord& record : {SampleRecord("a", "paper", 7), FailedRecord("b", "default", 1),
                                    SweepRecord(0.3, 2, true)}) {
    const TrialRecord back =
        TrialRecord::FromJson(nlohmann::ordered_json::parse(record.Json().dump()));
    EXPECT_TRUE(SameButTimings(record, back));
    EXPECT_EQ(record.Json(), back.Json());
  }
}

TEST(TrialRecord, ATableRecordHasEveryTiming) {
  const auto json = SampleRecord("a", "paper", 7).Json();
  for (const char* key :
       {"preparation_s", "graph_s", "confirmation_s", "motion_s", "verification_s", "memory_mb",
        "plan_duration_s", "real_time_ratio", "length_m"}) {
    EXPECT_TRUE(json.at(key).is_number()) << key;
  }
  EXPECT_NEAR(json["speed_m_s"].get<double>(), 7.0 / 300, 1e-12);
  EXPECT_TRUE(json["no"].is_null());
  const auto failed = FailedRecord("a", "paper", 7).Json();
  EXPECT_EQ(failed["no"], "time_limit");
  EXPECT_TRUE(failed["real_time_ratio"].is_null());
  EXPECT_TRUE(failed["plan_hash"].is_null());
  EXPECT_TRUE(failed["speed_m_s"].is_null());
}

TEST(TrialRecord, RecordsThatDifferInTimingsAndMachineAreTheSame) {
  const TrialRecord record = SampleRecord("a", "default", 1);
  TrialRecord other = record;
  other.timings = {};
  other.real_time_ratio = 3;
  other.machine = "another";
  EXPECT_TRUE(SameButTimings(record, other));
  const auto differs = [&](auto change) {
    TrialRecord changed = record;
    change(&changed);
    return !SameButTimings(record, changed);
  };
  EXPECT_TRUE(differs([](TrialRecord* r) { r->plan_hash += "x"; }));
  EXPECT_TRUE(differs([](TrialRecord* r) { r->counters["cycles"]++; }));
  EXPECT_TRUE(differs([](TrialRecord* r) { r->success = false; }));
  EXPECT_TRUE(differs([](TrialRecord* r) { r->length += 1e-9; }));
  EXPECT_TRUE(differs([](TrialRecord* r) { r->identity.robot_hash += "x"; }));
}

TEST(TrialRecord, SortsByRowValuePresetAndSeed) {
  std::vector<TrialRecord> expected = {SampleRecord("zebra", "default", 1),
                                       SampleRecord("zebra", "default", 2),
                                       SampleRecord("zebra", "default", 10),
                                       SampleRecord("zebra", "paper", 1),
                                       SampleRecord("ant", "default", 1),
                                       SweepRecord(-1, 5, true),
                                       SweepRecord(2, 1, true),
                                       SweepRecord(10, 1, true)};
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::vector<TrialRecord> records = expected;
    std::shuffle(records.begin(), records.end(), random);
    SortRecords({"zebra", "ant"}, &records);
    for (std::size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].key, expected[i].key);
  }
}

TEST(TrialRecord, HashDependsOnTheMotionOnly) {
  const models::RobotModel robot = testing::SampleRobot();
  const actions::Plan plan = testing::SamplePlan(robot, 2, 5);
  actions::Plan slower = plan;
  slower.timings = {9, 9, 9, 9, 9};
  slower.explored = {};
  EXPECT_EQ(MotionHash(plan), MotionHash(slower));
  actions::Plan changed = plan;
  changed.segments[1].phases[0].knots[2].tau[0] += 1e-12;
  EXPECT_NE(MotionHash(plan), MotionHash(changed));
  changed = plan;
  changed.segments[0].action = "crawl";
  EXPECT_NE(MotionHash(plan), MotionHash(changed));
  changed = plan;
  changed.segments[1].phases[0].contacts.pop_back();
  EXPECT_NE(MotionHash(plan), MotionHash(changed));
}

}  // namespace
}  // namespace possibility::experiments
