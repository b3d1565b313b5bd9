#include "experiments/exports/csv_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/samples/plan_samples.h"
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

std::vector<double> NumbersOf(const Row& row, std::size_t first, std::size_t end) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < std::min(end, row.size()); ++i) {
    numbers.push_back(std::stod(row[i]));
  }
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

class CsvTables : public ::testing::Test {
 protected:
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
};

TEST_F(CsvTables, HeaderNamesEveryColumnByJoint) {
  const Row header = Parse(Trajectory(plan_, robot_)).at(0);
  const Row expected = {"t",
                        "segment",
                        "action",
                        "q_root_qw",
                        "q_root_qx",
                        "q_root_qy",
                        "q_root_qz",
                        "q_root_x",
                        "q_root_y",
                        "q_root_z",
                        "q_hip",
                        "v_root_wx",
                        "v_root_wy",
                        "v_root_wz",
                        "v_root_x",
                        "v_root_y",
                        "v_root_z",
                        "v_hip",
                        "a_root_wx",
                        "a_root_wy",
                        "a_root_wz",
                        "a_root_x",
                        "a_root_y",
                        "a_root_z",
                        "a_hip",
                        "tau_hip",
                        "contact_sole_0",
                        "contact_sole_1",
                        "contact_sole_2",
                        "contact_sole_3",
                        "contact_peg_0"};
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
      EXPECT_EQ(NumbersOf(row, 3, row.size() - 5), Concatenated(knot));
      EXPECT_EQ(NumbersOf(row, row.size() - 5, row.size()),
                std::vector<double>({1, 1, 1, 1, static_cast<double>(s)}));
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
  const std::vector<double> numbers = NumbersOf(row, 5, row.size());
  EXPECT_NEAR(numbers[0], knot.q[4] + 0.2 * std::cos(yaw), 1e-12);
  EXPECT_NEAR(numbers[1], knot.q[5] + 0.2 * std::sin(yaw), 1e-12);
  EXPECT_NEAR(numbers[2], knot.q[6], 1e-12);
  EXPECT_EQ(numbers[3], knot.forces(0, 4));
}

TEST_F(CsvTables, FlagsTellWhichPointsBear) {
  actions::Plan plan = plan_;
  plan.segments[0].phases[0].contacts = {"sole[0,3]"};
  plan.segments[1].phases[0].contacts = {};
  const std::vector<Row> rows = Parse(Trajectory(plan, robot_));
  const auto flags = [](const Row& row) { return NumbersOf(row, row.size() - 5, row.size()); };
  EXPECT_EQ(flags(rows[1]), std::vector<double>({1, 0, 0, 1, 0}));
  EXPECT_EQ(flags(rows.back()), std::vector<double>(5, 0));
}

TEST_F(CsvTables, EveryColumnOfNumbersHasAUnit) {
  const std::vector<Row> units = Parse(UnitTable(robot_));
  const auto unit_of = [&](const std::string& table, const std::string& column) {
    for (const Row& row : units) {
      if (row[0] == table && row[1] == column) return row[2];
    }
    return std::string("none");
  };
  const Row header = Parse(Trajectory(plan_, robot_)).at(0);
  for (const std::string& column : header) {
    const bool is_number = column != "segment" && column != "action" && column.find("contact") != 0;
    EXPECT_EQ(unit_of("trajectory", column) != "none", is_number) << column;
  }
  EXPECT_EQ(unit_of("trajectory", "q_root_qw"), "1");
  EXPECT_EQ(unit_of("trajectory", "a_hip"), "rad/s^2");
  EXPECT_EQ(unit_of("trajectory", "tau_hip"), "N m");
  EXPECT_EQ(unit_of("contact_forces", "fz"), "N");
  EXPECT_EQ(unit_of("margins", "friction"), "1");
}

TEST_F(CsvTables, GainsAreThoseOfRollouts) {
  models::RobotModel robot = robot_;
  robot.joints[0].effort = 50;
  const std::vector<Row> rows = Parse(GainTable(robot));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1][0], "hip");
  const actions::RolloutGains gains;
  EXPECT_DOUBLE_EQ(std::stod(rows[1][1]), 50 / gains.full_effort_error);
  EXPECT_DOUBLE_EQ(std::stod(rows[1][2]), 50 / gains.full_effort_error * gains.damping_time);
}

TEST_F(CsvTables, GainsHaveTheLineOfAMotorThatHasOne) {
  models::RobotModel robot = robot_;
  EXPECT_TRUE(GainTable(robot).ends_with("m s/rad,,\n")) << GainTable(robot);
  robot.joints[0].actuator.line = models::TorqueSpeedLine{120.5, 8};
  EXPECT_TRUE(GainTable(robot).ends_with("m s/rad,120.5,8\n")) << GainTable(robot);
}

TEST_F(CsvTables, MarginsWithoutAMeasurementAreEmpty) {
  actions::PlanMargins margins;
  margins.torque = {0.5, 1, 2.0};
  EXPECT_EQ(MarginTable::Header(),
            "t,zmp,ground_edge,torque,friction,joint_speed,self_distance,obstacle_distance\n");
  EXPECT_EQ(MarginTable::Row(2, margins), "2,,,0.5,,,,\n");
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

TEST_F(CsvTables, QuotesNamesWithCommasAndQuotes) {
  models::RobotModel robot = robot_;
  robot.joints[0].name = "hip, \"left\"";
  const std::string csv = Trajectory(plan_, robot);
  EXPECT_NE(csv.find("\"tau_hip, \"\"left\"\"\""), std::string::npos) << csv;
}

}  // namespace
}  // namespace possibility::experiments
