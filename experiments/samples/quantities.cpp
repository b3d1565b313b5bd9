#include "experiments/samples/quantities.h"

#include <fmt/format.h>

namespace possibility::experiments {
namespace {

bool Slides(const models::Joint& joint) { return joint.type == models::JointType::kPrismatic; }

/// Units of the root's rotation and translation rates; `per`: "/s" or "/s^2".
std::vector<Quantity> RateQuantities(const models::RobotModel& robot, const std::string& per) {
  std::vector<Quantity> quantities;
  for (const char* name : {"root_wx", "root_wy", "root_wz"}) {
    quantities.push_back({name, "rad" + per});
  }
  for (const char* name : {"root_x", "root_y", "root_z"}) quantities.push_back({name, "m" + per});
  for (const models::Joint& joint : robot.joints) {
    quantities.push_back({joint.name, (Slides(joint) ? "m" : "rad") + per});
  }
  return quantities;
}

/// Index of the first point of every patch in AllContactPoints.
std::vector<int> FirstColumns(const models::RobotModel& robot) {
  std::vector<int> first;
  int column = 0;
  for (const models::ContactPatch& patch : robot.contacts) {
    first.push_back(column);
    column += static_cast<int>(patch.points.size());
  }
  return first;
}

}  // namespace

std::vector<Quantity> ConfigurationQuantities(const models::RobotModel& robot) {
  std::vector<Quantity> quantities;
  for (const char* name : {"root_qw", "root_qx", "root_qy", "root_qz"}) {
    quantities.push_back({name, "1"});
  }
  for (const char* name : {"root_x", "root_y", "root_z"}) quantities.push_back({name, "m"});
  for (const models::Joint& joint : robot.joints) {
    quantities.push_back({joint.name, Slides(joint) ? "m" : "rad"});
  }
  return quantities;
}

std::vector<Quantity> VelocityQuantities(const models::RobotModel& robot) {
  return RateQuantities(robot, "/s");
}

std::vector<Quantity> AccelerationQuantities(const models::RobotModel& robot) {
  return RateQuantities(robot, "/s^2");
}

std::vector<Quantity> TorqueQuantities(const models::RobotModel& robot) {
  std::vector<Quantity> quantities;
  for (const models::Joint& joint : robot.joints) {
    quantities.push_back({joint.name, Slides(joint) ? "N" : "N m"});
  }
  return quantities;
}

std::vector<actions::BearingPoint> AllContactPoints(const models::RobotModel& robot) {
  std::vector<actions::BearingPoint> points;
  for (int patch = 0; patch < static_cast<int>(robot.contacts.size()); ++patch) {
    const models::ContactPatch& contact = robot.contacts[patch];
    for (int i = 0; i < static_cast<int>(contact.points.size()); ++i) {
      points.push_back({patch, i, contact.link, contact.points[i]});
    }
  }
  return points;
}

std::string ContactColumn(const models::RobotModel& robot, const actions::BearingPoint& point) {
  return fmt::format("{}_{}", robot.contacts[point.patch].name, point.index);
}

std::vector<int> BearingColumns(const models::RobotModel& robot, const actions::Phase& phase) {
  const std::vector<int> first = FirstColumns(robot);
  std::vector<int> columns;
  for (const actions::BearingPoint& point : actions::BearingPoints(robot, phase)) {
    columns.push_back(first[point.patch] + point.index);
  }
  return columns;
}

const std::vector<MarginQuantity>& MarginQuantities() {
  using actions::PlanMargins;
  static const std::vector<MarginQuantity> quantities = {
      {"zmp", "m", &PlanMargins::zmp},
      {"ground_edge", "m", &PlanMargins::ground_edge},
      {"torque", "1", &PlanMargins::torque},
      {"friction", "1", &PlanMargins::friction},
      {"joint_speed", "1", &PlanMargins::joint_speed},
      {"self_distance", "m", &PlanMargins::self_distance},
      {"obstacle_distance", "m", &PlanMargins::obstacle_distance},
  };
  return quantities;
}

JointGains GainsOf(const models::RobotModel& robot, const actions::RolloutGains& gains) {
  const Eigen::VectorXd stiffness = actions::JointStiffness(robot, gains);
  return {stiffness, gains.damping_time * stiffness};
}

}  // namespace possibility::experiments
