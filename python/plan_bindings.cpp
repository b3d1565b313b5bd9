#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/exports/plan_export.h"
#include "python/bindings.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using actions::Knot;
using actions::Phase;
using actions::Plan;
using actions::Segment;
using experiments::LoadedPlan;
using Array = py::array_t<double>;

/// The knot's numbers of that name.
Eigen::Map<const Eigen::VectorXd> Numbers(const Knot& knot, const std::string& name) {
  const auto map = [](const auto& numbers) {
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
  };
  if (name == "t") return {&knot.t, 1};
  if (name == "q") return map(knot.q);
  if (name == "v") return map(knot.v);
  if (name == "a") return map(knot.a);
  if (name == "tau") return map(knot.tau);
  if (name == "forces") return map(knot.forces);
  throw std::invalid_argument("a knot has no '" + name + "'");
}

Array ReadOnly(Array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A view of numbers that `owner` keeps alive.
Array View(const Eigen::Map<const Eigen::VectorXd>& numbers, const py::object& owner) {
  return ReadOnly(Array(numbers.size(), numbers.data(), owner));
}

/// The numbers of all knots, one knot after the other.
Array Stacked(const LoadedPlan& loaded, const std::string& name) {
  std::vector<Eigen::Map<const Eigen::VectorXd>> parts;
  for (const Segment& segment : loaded.plan.segments) {
    for (const Phase& phase : segment.phases) {
      for (const Knot& knot : phase.knots) parts.push_back(Numbers(knot, name));
    }
  }
  py::ssize_t size = 0;
  for (const auto& part : parts) size += part.size();
  Array array(size);
  double* to = array.mutable_data();
  for (const auto& part : parts) to = std::copy(part.data(), part.data() + part.size(), to);
  return ReadOnly(array);
}

const Phase& PhaseOf(const LoadedPlan& loaded, std::size_t segment, std::size_t phase) {
  return loaded.plan.segments.at(segment).phases.at(phase);
}

/// Names and sizes of segments and phases.
py::list OutlineOf(const LoadedPlan& loaded) {
  py::list segments;
  for (const Segment& segment : loaded.plan.segments) {
    py::list phases;
    for (const Phase& phase : segment.phases) {
      phases.append(py::make_tuple(phase.contacts, phase.knots.size(),
                                   phase.knots.front().forces.cols(), phase.impulses.cols()));
    }
    segments.append(
        py::make_tuple(segment.action, segment.vertices[0], segment.vertices[1], phases));
  }
  return segments;
}

py::dict TimingsOf(const LoadedPlan& loaded) {
  const actions::PlanTimings& timings = loaded.plan.timings;
  py::dict entry;
  entry["preparation_s"] = timings.preparation_s;
  entry["graph_s"] = timings.graph_s;
  entry["confirmation_s"] = timings.confirmation_s;
  entry["motion_s"] = timings.motion_s;
  entry["verification_s"] = timings.verification_s;
  return entry;
}

std::shared_ptr<LoadedPlan> Load(const std::string& path) {
  const py::gil_scoped_release release;
  auto loaded = std::make_shared<LoadedPlan>(experiments::LoadPlanToVerify(path, {}));
  experiments::RequireFit(*loaded);
  return loaded;
}

/// In the format that the file's name asks for; of a scenario in another file with the same content
/// unless `scenario_file` is empty.
void Save(const LoadedPlan& loaded, const std::string& file, const std::string& scenario_file) {
  const py::gil_scoped_release release;
  const auto write = [&](const Plan& plan) {
    experiments::WritePlanFile({plan, loaded.robot, loaded.scenario}, {}, file);
  };
  if (scenario_file.empty()) return write(loaded.plan);
  Plan plan = loaded.plan;
  plan.scenario_file = scenario_file;
  write(plan);
}

}  // namespace

void BindPlans(py::module_& module) {
  py::class_<LoadedPlan, std::shared_ptr<LoadedPlan>>(module, "PlanData")
      .def_property_readonly("file", [](const LoadedPlan& loaded) { return loaded.file.string(); })
      .def_property_readonly("seed", [](const LoadedPlan& loaded) { return loaded.plan.seed; })
      .def_property_readonly("goal", [](const LoadedPlan& loaded) { return loaded.plan.goal; })
      .def_property_readonly("duration",
                             [](const LoadedPlan& loaded) { return loaded.plan.duration(); })
      .def_property_readonly("joints", [](const LoadedPlan& loaded) { return loaded.plan.joints; })
      .def_property_readonly("statistics",
                             [](const LoadedPlan& loaded) { return loaded.plan.statistics; })
      .def_property_readonly("timings", &TimingsOf)
      .def_property_readonly("robot",
                             [](const LoadedPlan& loaded) {
                               return std::make_shared<models::RobotModel>(loaded.robot);
                             })
      .def_property_readonly("scenario",
                             [](const LoadedPlan& loaded) {
                               return std::make_shared<models::Scenario>(loaded.scenario);
                             })
      .def_property_readonly("is_current", &LoadedPlan::IsCurrent)
      .def("outline", &OutlineOf)
      .def("stacked", &Stacked)
      .def("knot",
           [](const py::object& self, std::size_t segment, std::size_t phase, std::size_t knot,
              const std::string& name) {
             const auto& loaded = self.cast<const LoadedPlan&>();
             return View(Numbers(PhaseOf(loaded, segment, phase).knots.at(knot), name), self);
           })
      .def("impulses",
           [](const py::object& self, std::size_t segment, std::size_t phase) {
             const auto& impulses =
                 PhaseOf(self.cast<const LoadedPlan&>(), segment, phase).impulses;
             return View({impulses.data(), impulses.size()}, self);
           })
      .def("save", &Save);
  module.def("load_plan", &Load);
}

}  // namespace possibility::python
