#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/solver/status_name.h"
#include "collocation/study/optimal_control.h"
#include "python/bindings.h"
#include "python/interruptible.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using collocation::OptimalControlOptions;
using collocation::OptimalControlProblem;
using collocation::OptimalControlResult;
using collocation::TranscriptionScheme;
using collocation::Variable;

using Array = py::array_t<double>;

TranscriptionScheme SchemeNamed(const std::string& name, int nodes) {
  if (name == "trapezoidal") return collocation::Trapezoidal();
  if (name == "hermite_simpson") return collocation::HermiteSimpson();
  if (name == "hermite_simpson_compressed") return collocation::CompressedHermiteSimpson();
  if (name == "gauss_lobatto") return collocation::GaussLobatto(nodes);
  if (name == "legendre_gauss") return collocation::LegendreGauss(nodes);
  if (name == "flipped_radau") return collocation::FlippedRadau(nodes);
  throw std::invalid_argument(
      "scheme: '" + name +
      "', expected trapezoidal, hermite_simpson, hermite_simpson_compressed, gauss_lobatto, "
      "legendre_gauss or flipped_radau");
}

OptimalControlOptions OptionsOf(const py::dict& given) {
  OptimalControlOptions options;
  options.scheme = SchemeNamed(given["scheme"].cast<std::string>(), given["nodes"].cast<int>());
  options.intervals = given["intervals"].cast<std::vector<int>>();
  options.mesh_tolerance = given["mesh_tolerance"].cast<double>();
  options.jump_tolerance = given["jump_tolerance"].cast<double>();
  options.coarse_first = given["coarse_first"].cast<bool>();
  options.solver.tolerance = given["tolerance"].cast<double>();
  options.solver.max_iterations = given["max_iterations"].cast<int>();
  options.solver.time_limit = given["time_limit"].cast<double>();
  options.check_derivatives = given["check_derivatives"].cast<bool>();
  options.second_order_check = given["second_order_check"].cast<bool>();
  options.explain_infeasible = true;
  return options;
}

std::shared_ptr<OptimalControlResult> SolveProblem(
    const std::shared_ptr<OptimalControlProblem>& problem, const py::dict& given) {
  auto solution = std::make_shared<OptimalControlResult>();
  const OptimalControlOptions options = OptionsOf(given);
  RunInterruptibly([=](const CancellationToken& cancellation) {
    *solution = collocation::SolveOptimalControl(*problem, options, std::nullopt, cancellation);
  });
  return solution;
}

Array ValuesAt(const OptimalControlResult& solution, const Variable& variable, const Array& times) {
  Array values(times.size());
  for (py::ssize_t i = 0; i < times.size(); ++i) {
    values.mutable_at(i) = solution.Value(variable, times.at(i));
  }
  return values;
}

/// The times of the points of the mesh, s.
Array TimesOf(const OptimalControlResult& solution, std::size_t index) {
  const collocation::PhaseTrajectory& phase = solution.trajectory.phases.at(index);
  Array times(phase.num_points());
  for (int i = 0; i < phase.num_points(); ++i) {
    times.mutable_at(i) = phase.begin + phase.PointShare(i) * phase.duration;
  }
  return times;
}

}  // namespace

void BindSolutions(py::module_& module) {
  py::class_<OptimalControlResult, std::shared_ptr<OptimalControlResult>>(module, "SolutionData")
      .def_property_readonly("status",
                             [](const OptimalControlResult& solution) {
                               return collocation::StatusName(solution.status);
                             })
      .def_property_readonly("succeeded", &OptimalControlResult::succeeded)
      .def_readonly("message", &OptimalControlResult::message)
      .def_readonly("objective", &OptimalControlResult::objective)
      .def_readonly("iterations", &OptimalControlResult::iterations)
      .def_readonly("mesh_error", &OptimalControlResult::mesh_error)
      .def_readonly("refinements", &OptimalControlResult::refinements)
      .def_readonly("conflict", &OptimalControlResult::conflict)
      .def_property_readonly("seconds", [](const OptimalControlResult& s) { return s.times.total; })
      .def("values", &ValuesAt)
      .def("times", &TimesOf)
      .def_property_readonly("num_phases", [](const OptimalControlResult& solution) {
        return solution.trajectory.phases.size();
      });
  module.def("solve", &SolveProblem);
}

}  // namespace possibility::python
