#include "experiments/report/rollout_table.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace possibility::experiments {
namespace {

using actions::PerturbedRollout;
using actions::RolloutDrift;

/// A walk and a jump, one stretch each, under one perturbation.
class RolloutTableTest : public ::testing::Test {
 protected:
  std::vector<std::string> Row(const RolloutDrift& walk, const RolloutDrift& jump) const {
    const PerturbedRollout rollout{{}, {{0, 0, walk}, {1, 1, jump}}};
    const TextTable table = RolloutTable(plan_, {"mass=1.05"}, {rollout});
    EXPECT_EQ(table.rows.size(), 1u);
    EXPECT_EQ(table.rows.front().size(), table.header.size());
    return table.rows.front();
  }

  actions::Plan plan_ = [] {
    actions::Plan plan;
    plan.segments = {{"walk", {}}, {"jump", {}}};
    return plan;
  }();
};

TEST_F(RolloutTableTest, DeviationsAreTheWorstOfAllStretches) {
  RolloutDrift walk;
  walk.worst_position = 0.0123;
  walk.torque_used = 0.4;
  RolloutDrift jump;
  jump.worst_position = 0.0045;
  jump.torque_used = 0.91;
  const std::vector<std::string> row = Row(walk, jump);
  EXPECT_EQ(row[0], "mass=1.05");
  EXPECT_EQ(row[1], "survives");
  EXPECT_EQ(row[2], "0.0123");
  EXPECT_EQ(row[6], "0.91");
}

TEST_F(RolloutTableTest, TheOutcomeIsThatOfTheFirstStretchThatFails) {
  RolloutDrift falls;
  falls.fell_at = 4.213;
  RolloutDrift fails;
  fails.failure = "too many events";
  EXPECT_EQ(Row({}, falls)[1], "falls at 4.21 s (jump)");
  EXPECT_EQ(Row(fails, falls)[1], "too many events (walk)");
}

TEST_F(RolloutTableTest, NoPerturbationIsCalledNone) {
  const TextTable table = RolloutTable(plan_, {""}, {PerturbedRollout{{}, {}}});
  EXPECT_EQ(table.rows.front().front(), "none");
}

}  // namespace
}  // namespace possibility::experiments
