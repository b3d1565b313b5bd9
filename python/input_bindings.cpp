#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"
#include "python/bindings.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using models::RobotModel;
using models::Scenario;

template <typename Item>
std::vector<std::string> NamesOf(const std::vector<Item>& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

py::dict ActuatorsOf(const RobotModel& robot) {
  py::dict actuators;
  for (const models::Joint& joint : robot.joints) {
    const models::Actuator& actuator = joint.actuator;
    if (!actuator.HasLosses() && !actuator.line) continue;
    py::dict entry;
    entry["armature"] = actuator.armature;
    entry["viscous_friction"] = actuator.viscous_friction;
    entry["dry_friction"] = actuator.dry_friction;
    entry["dry_speed"] = actuator.dry_speed;
    if (actuator.line) {
      entry["stall_torque"] = actuator.line->stall_torque;
      entry["no_load_speed"] = actuator.line->no_load_speed;
    }
    actuators[py::str(joint.name)] = entry;
  }
  return actuators;
}

py::dict LimitsOf(const RobotModel& robot) {
  py::dict limits;
  for (const models::Joint& joint : robot.joints) {
    py::dict entry;
    entry["lower"] = joint.lower;
    entry["upper"] = joint.upper;
    entry["velocity"] = joint.velocity;
    entry["effort"] = joint.effort;
    limits[py::str(joint.name)] = entry;
  }
  return limits;
}

py::dict ToDict(const models::Stance& stance) {
  py::dict entry;
  entry["action"] = stance.action;
  entry["x"] = stance.x;
  entry["y"] = stance.y;
  entry["z"] = stance.z;
  entry["yaw"] = stance.yaw;
  return entry;
}

py::list GoalsOf(const Scenario& scenario) {
  py::list goals;
  for (const models::Stance& goal : scenario.goals) goals.append(ToDict(goal));
  return goals;
}

void BindRobot(py::module_& module) {
  py::class_<RobotModel, std::shared_ptr<RobotModel>>(module, "Robot")
      .def_readonly("name", &RobotModel::name)
      .def_property_readonly("file", [](const RobotModel& robot) { return robot.file.string(); })
      .def_property_readonly("mass", &RobotModel::TotalMass)
      .def_property_readonly("joints",
                             [](const RobotModel& robot) { return NamesOf(robot.joints); })
      .def_property_readonly("links", [](const RobotModel& robot) { return NamesOf(robot.links); })
      .def_property_readonly("contacts",
                             [](const RobotModel& robot) { return NamesOf(robot.contacts); })
      .def_property_readonly("gaits", [](const RobotModel& robot) { return NamesOf(robot.gaits); })
      .def_property_readonly("jumps", [](const RobotModel& robot) { return NamesOf(robot.jumps); })
      .def_property_readonly("limits", &LimitsOf)
      .def_property_readonly("actuators", &ActuatorsOf);
  module.def("load_robot", [](const std::string& file) {
    return std::make_shared<RobotModel>(models::LoadRobotModel(file));
  });
}

void BindScenario(py::module_& module) {
  py::class_<Scenario, std::shared_ptr<Scenario>>(module, "Scenario")
      .def_readonly("name", &Scenario::name)
      .def_property_readonly("file",
                             [](const Scenario& scenario) { return scenario.file.string(); })
      .def_property_readonly("robot_file",
                             [](const Scenario& scenario) { return scenario.robot_file.string(); })
      .def_readonly("actions", &Scenario::actions)
      .def_property_readonly("start",
                             [](const Scenario& scenario) { return ToDict(scenario.start); })
      .def_property_readonly("goals", &GoalsOf)
      .def_readonly("time_limit", &Scenario::time_limit)
      .def_readonly("seed", &Scenario::seed);
  module.def("load_scenario", [](const std::string& file) {
    return std::make_shared<Scenario>(models::LoadScenario(file));
  });
}

}  // namespace

void BindInputs(py::module_& module) {
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  BindRobot(module);
  BindScenario(module);
}

}  // namespace possibility::python
