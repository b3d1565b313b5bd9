#include "experiments/report/csv_tables.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "models/input/input_error.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

using Row = std::vector<std::string>;

std::vector<Row> Parse(const std::string& csv) {
  std::vector<Row> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

std::vector<double> Numbers(const Row& row, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < row.size(); ++i) numbers.push_back(std::stod(row[i]));
  return numbers;
}

std::vector<double> Concatenated(const actions::Knot& knot) {
  std::vector<double> numbers;
  for (const auto* part : {&knot.q, &knot.v, &knot.a, &knot.tau}) {
    numbers.insert(numbers.end(), part->begin(), part->end());
  }
  return numbers;
}

std::string Trajectory(const actions::Plan& plan, const models::RobotModel& robot) {
  const TrajectoryTable table(plan, robot);
  std::string csv = table.Header();
  VisitKnots(plan, [&](const PlanSample& sample) { csv += table.Rows(sample); });
  return csv;
}

std::string ContactForces(const actions::Plan& plan, const models::RobotModel& robot) {
  ContactForceTable table(plan, robot);
  std::string csv = table.Header();
  VisitKnots(plan, [&](const PlanSample& sample) { csv += table.Rows(sample); });
  return csv;
}

std::vector<PlanSample> SamplesEvery(const actions::Plan& plan, double step) {
  std::vector<PlanSample> samples;
  VisitEvery(plan, step, [&](const PlanSample& sample) { samples.push_back(sample); });
  return samples;
}

class CsvTables : public ::testing::Test {
 protected:
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
};

TEST_F(CsvTables, HeaderNamesEveryColumnByJoint) {
  const Row header = Parse(Trajectory(plan_, robot_)).at(0);
  const Row expected = {
      "t",        "segment",  "action",   "q_root_qw", "q_root_qx", "q_root_qy", "q_root_qz",
      "q_root_x", "q_root_y", "q_root_z", "q_hip",     "v_root_wx", "v_root_wy", "v_root_wz",
      "v_root_x", "v_root_y", "v_root_z", "v_hip",     "a_root_wx", "a_root_wy", "a_root_wz",
      "a_root_x", "a_root_y", "a_root_z", "a_hip",     "tau_hip"};
  EXPECT_EQ(header, expected);
}

TEST_F(CsvTables, KnotsReadBackToTheSameNumbers) {
  const std::vector<Row> rows = Parse(Trajectory(plan_, robot_));
  ASSERT_EQ(rows.size(), 1u + 2 * 9);
  for (int s = 0; s < 2; ++s) {
    for (int k = 0; k < 9; ++k) {
      const Row& row = rows[1 + 9 * s + k];
      const actions::Knot& knot = plan_.segments[s].phases[0].knots[k];
      EXPECT_EQ(std::stod(row[0]), knot.t);
      EXPECT_EQ(row[1], std::to_string(s));
      EXPECT_EQ(row[2], plan_.segments[s].action);
      EXPECT_EQ(Numbers(row, 3), Concatenated(knot));
    }
  }
}

TEST_F(CsvTables, ForcesAreListedWithTheirPoints) {
  const std::vector<Row> rows = Parse(ContactForces(plan_, robot_));
  ASSERT_EQ(rows.size(), 1u + 9 * 4 + 9 * 5);
  // The peg is the last point of the last knot, fixed to the root at (0.2, 0, 0).
  const Row& row = rows.back();
  const actions::Knot& knot = plan_.segments[1].phases[0].knots.back();
  EXPECT_EQ(row[3], "peg");
  EXPECT_EQ(row[4], "0");
  const double yaw = knot.t / 10;
  const std::vector<double> numbers = Numbers(row, 5);
  EXPECT_NEAR(numbers[0], knot.q[4] + 0.2 * std::cos(yaw), 1e-12);
  EXPECT_NEAR(numbers[1], knot.q[5] + 0.2 * std::sin(yaw), 1e-12);
  EXPECT_NEAR(numbers[2], knot.q[6], 1e-12);
  EXPECT_EQ(numbers[3], knot.forces(0, 4));
}

TEST_F(CsvTables, PartOfAPatchIsListedByItsOwnPoints) {
  actions::Plan plan = plan_;
  actions::Phase& phase = plan.segments[0].phases[0];
  phase.contacts = {"sole[0,3]"};
  for (actions::Knot& knot : phase.knots) knot.forces = Eigen::Matrix3Xd::Random(3, 2);
  const std::vector<Row> rows = Parse(ContactForces(plan, robot_));
  ASSERT_EQ(rows.size(), 1u + 9 * 2 + 9 * 5);
  const std::vector<Row> whole = Parse(ContactForces(plan_, robot_));
  EXPECT_EQ(rows[1][3], "sole");
  EXPECT_EQ(rows[1][4], "0");
  EXPECT_EQ(rows[2][4], "3");
  for (int i : {5, 6, 7}) EXPECT_EQ(rows[2][i], whole[4][i]);
  EXPECT_EQ(std::stod(rows[2][8]), phase.knots[0].forces(0, 1));
}

TEST_F(CsvTables, StepGivesEvenTimesAndTheEnd) {
  const std::vector<PlanSample> samples = SamplesEvery(plan_, 0.3);
  ASSERT_EQ(samples.size(), 15u);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    EXPECT_NEAR(samples[i].knot.t, 0.3 * i, 1e-12);
    EXPECT_EQ(samples[i].segment, 0.3 * i < 2 ? 0 : 1);
  }
  EXPECT_EQ(samples.back().knot.t, 4);
}

TEST_F(CsvTables, StepThatLandsOnAKnotGivesThatKnot) {
  const std::vector<PlanSample> samples = SamplesEvery(plan_, 0.5);
  ASSERT_EQ(samples.size(), 9u);
  EXPECT_EQ(samples[4].segment, 1) << "where two phases meet, the later one counts";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& knots = plan_.segments[i < 4 ? 0 : 1].phases[0].knots;
    const actions::Knot& knot = knots[2 * (i < 4 ? i : i - 4)];
    EXPECT_LT((samples[i].knot.q - knot.q).norm(), 1e-9);
    EXPECT_LT((samples[i].knot.forces - knot.forces).norm(), 1e-9);
  }
}

TEST_F(CsvTables, RefusesAStepOfTooManyRows) {
  EXPECT_THROW(SamplesEvery(plan_, 1e-9), InputError);
}

TEST_F(CsvTables, QuotesNamesWithCommasAndQuotes) {
  models::RobotModel robot = robot_;
  robot.joints[0].name = "hip, \"left\"";
  const std::string csv = Trajectory(plan_, robot);
  EXPECT_NE(csv.find("\"tau_hip, \"\"left\"\"\""), std::string::npos) << csv;
}

}  // namespace
}  // namespace possibility::experiments
