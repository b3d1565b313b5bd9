#include "experiments/exports/csv_tables.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "actions/plan/contact_name.h"

namespace possibility::experiments {
namespace {

void AppendNames(const char* prefix, const std::vector<Quantity>& quantities, std::string* row) {
  for (const Quantity& quantity : quantities) {
    *row += "," + CsvField(fmt::format("{}_{}", prefix, quantity.name));
  }
}

void AppendNumbers(const Eigen::VectorXd& numbers, std::string* row) {
  for (const double number : numbers) fmt::format_to(std::back_inserter(*row), ",{}", number);
}

void AppendUnits(const char* prefix, const std::vector<Quantity>& quantities, std::string* rows) {
  for (const Quantity& quantity : quantities) {
    *rows += fmt::format("trajectory,{},{}\n",
                         CsvField(fmt::format("{}_{}", prefix, quantity.name)), quantity.unit);
  }
}

}  // namespace

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

TrajectoryTable::TrajectoryTable(const actions::Plan& plan, const models::RobotModel& robot)
    : plan_(plan), robot_(robot), points_(AllContactPoints(robot)) {}

std::string TrajectoryTable::Header() const {
  std::string text = "t,segment,action";
  AppendNames("q", ConfigurationQuantities(robot_), &text);
  AppendNames("v", VelocityQuantities(robot_), &text);
  AppendNames("a", AccelerationQuantities(robot_), &text);
  AppendNames("tau", TorqueQuantities(robot_), &text);
  for (const actions::BearingPoint& point : points_) {
    text += "," + CsvField("contact_" + ContactColumn(robot_, point));
  }
  return text + "\n";
}

std::string TrajectoryTable::Rows(const PlanSample& sample) const {
  std::string text = fmt::format("{},{},{}", sample.knot.t, sample.segment,
                                 CsvField(plan_.segments[sample.segment].action));
  for (const auto* numbers : {&sample.knot.q, &sample.knot.v, &sample.knot.a, &sample.knot.tau}) {
    AppendNumbers(*numbers, &text);
  }
  std::string flags;
  for (std::size_t i = 0; i < points_.size(); ++i) flags += ",0";
  for (const int column : BearingColumns(robot_, *sample.phase)) flags[2 * column + 1] = '1';
  return text + flags + "\n";
}

std::string ContactForceTable::Header() const {
  return "t,segment,action,patch,point,x,y,z,fx,fy,fz\n";
}

std::string ContactForceTable::Rows(const PlanSample& sample) {
  std::string text;
  kinematics_.SetPosition(sample.knot.q);
  Eigen::Index column = 0;
  for (const actions::BearingPatch& bearing : actions::BearingPatches(robot_, *sample.phase)) {
    const models::ContactPatch& patch = robot_.contacts[bearing.patch];
    for (const int i : bearing.points) {
      text += fmt::format("{},{},{},{},{}", sample.knot.t, sample.segment,
                          CsvField(plan_.segments[sample.segment].action), CsvField(patch.name), i);
      AppendNumbers(kinematics_.Position(patch.link, patch.points[i]), &text);
      AppendNumbers(sample.knot.forces.col(column++), &text);
      text += "\n";
    }
  }
  return text;
}

std::string MarginTable::Header() {
  std::string text = "t";
  for (const MarginQuantity& quantity : MarginQuantities()) text += "," + quantity.name;
  return text + "\n";
}

std::string MarginTable::Row(double t, const actions::PlanMargins& margins) {
  std::string text = fmt::format("{}", t);
  for (const MarginQuantity& quantity : MarginQuantities()) {
    const actions::Margin& margin = margins.*quantity.margin;
    text += margin.segment < 0 ? "," : fmt::format(",{}", margin.value);
  }
  return text + "\n";
}

std::string UnitTable(const models::RobotModel& robot) {
  std::string rows = "table,column,unit\ntrajectory,t,s\n";
  AppendUnits("q", ConfigurationQuantities(robot), &rows);
  AppendUnits("v", VelocityQuantities(robot), &rows);
  AppendUnits("a", AccelerationQuantities(robot), &rows);
  AppendUnits("tau", TorqueQuantities(robot), &rows);
  rows += "contact_forces,t,s\n";
  for (const char* place : {"x", "y", "z"}) rows += fmt::format("contact_forces,{},m\n", place);
  for (const char* force : {"fx", "fy", "fz"}) rows += fmt::format("contact_forces,{},N\n", force);
  rows += "margins,t,s\n";
  for (const MarginQuantity& quantity : MarginQuantities()) {
    rows += fmt::format("margins,{},{}\n", quantity.name, quantity.unit);
  }
  return rows;
}

std::string GainTable(const models::RobotModel& robot) {
  const JointGains gains = GainsOf(robot);
  std::string rows =
      "joint,stiffness,damping,effort,speed,stiffness_unit,damping_unit,stall_torque,"
      "no_load_speed\n";
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const bool slides = joint.type == models::JointType::kPrismatic;
    const auto& line = joint.actuator.line;
    rows += fmt::format("{},{},{},{},{},{},{},{}\n", CsvField(joint.name), gains.stiffness[j],
                        gains.damping[j], joint.effort, joint.velocity, slides ? "N/m" : "N m/rad",
                        slides ? "N s/m" : "N m s/rad",
                        line ? fmt::format("{},{}", line->stall_torque, line->no_load_speed) : ",");
  }
  return rows;
}

}  // namespace possibility::experiments
