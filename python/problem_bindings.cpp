#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "experiments/problems/regression_problems.h"
#include "python/bindings.h"
#include "python/tape.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using collocation::At;
using collocation::Bounds;
using collocation::Function;
using collocation::OptimalControlProblem;
using collocation::Variable;
using collocation::VariableAt;

using SharedProblem = std::shared_ptr<OptimalControlProblem>;
using Interval = std::pair<double, double>;
using Array = py::array_t<double>;
/// name of operation, first, second, constant
using TapeRow = std::tuple<std::string, int, int, double>;

/// A function in Python's hands.
struct TapeHandle {
  std::shared_ptr<Function> function;
};

TapeHandle MakeTape(int num_inputs, const std::vector<TapeRow>& rows, std::vector<int> outputs) {
  Tape tape{num_inputs, {}, std::move(outputs)};
  for (const auto& [name, first, second, constant] : rows) {
    tape.entries.push_back({TapeOperationNamed(name), first, second, constant});
  }
  return {FunctionOfTape(std::move(tape))};
}

At AtNamed(const std::string& name) {
  if (name == "everywhere") return At::kEverywhere;
  if (name == "start") return At::kStart;
  if (name == "end") return At::kEnd;
  if (name == "after_start") return At::kAfterStart;
  if (name == "before_end") return At::kBeforeEnd;
  if (name == "inside") return At::kInside;
  throw std::invalid_argument("at: '" + name +
                              "', expected everywhere, start, end, after_start, before_end or "
                              "inside");
}

Bounds ToBounds(const Interval& interval) { return {interval.first, interval.second}; }

std::vector<Bounds> ToBounds(const std::vector<Interval>& intervals) {
  std::vector<Bounds> bounds;
  bounds.reserve(intervals.size());
  for (const Interval& interval : intervals) bounds.push_back(ToBounds(interval));
  return bounds;
}

/// Quantities, each with the share of its phase's duration; none for what does not change.
using Instants = std::vector<std::pair<Variable, std::optional<double>>>;

VariableAt ToInstant(const std::pair<Variable, std::optional<double>>& argument) {
  const auto& [variable, share] = argument;
  if (!share || *share == 0) return {variable, At::kStart};
  if (*share == 1) return {variable, At::kEnd};
  return collocation::AtShare(variable, *share);
}

std::vector<VariableAt> ToInstants(const Instants& arguments) {
  std::vector<VariableAt> instants;
  for (const auto& argument : arguments) instants.push_back(ToInstant(argument));
  return instants;
}

/// The line through values that are spread evenly over the duration.
std::function<double(double)> Sampled(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("guess: expected at least one value");
  return [values = std::move(values)](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto before = static_cast<std::size_t>(place);
    if (before + 1 >= values.size()) return values.back();
    const double part = place - static_cast<double>(before);
    return (1 - part) * values[before] + part * values[before + 1];
  };
}

/// Every quantity of a phase with its name.
std::vector<std::pair<std::string, Variable>> QuantitiesOf(const OptimalControlProblem& problem,
                                                           int index) {
  const collocation::Phase& phase = problem.phase(index);
  std::vector<std::pair<std::string, Variable>> named;
  for (std::size_t i = 0; i < phase.coordinates().size(); ++i) {
    named.emplace_back(phase.coordinates()[i].front().name, phase.Coordinate(static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < phase.controls().size(); ++i) {
    named.emplace_back(phase.controls()[i].name, phase.Control(static_cast<int>(i)));
  }
  return named;
}

Array ToArray(const Eigen::MatrixXd& matrix) {
  Array array({matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.mutable_at(i, j) = matrix(i, j);
  }
  return array;
}

/// Values, Jacobian, and the Hessian of each output.
py::tuple EvaluateTape(const TapeHandle& tape, const std::vector<double>& inputs) {
  Function& function = *tape.function;
  if (static_cast<int>(inputs.size()) != function.num_inputs()) {
    throw std::invalid_argument("tape: expected " + std::to_string(function.num_inputs()) +
                                " inputs, got " + std::to_string(inputs.size()));
  }
  const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(inputs.data(), inputs.size());
  Eigen::VectorXd y(function.num_outputs());
  Eigen::MatrixXd J(function.num_outputs(), function.num_inputs());
  function.Evaluate(z, &y);
  function.Jacobian(z, &J);
  py::list hessians;
  for (int i = 0; i < function.num_outputs(); ++i) {
    Eigen::MatrixXd H(function.num_inputs(), function.num_inputs());
    function.Hessian(z, Eigen::VectorXd::Unit(function.num_outputs(), i), &H);
    hessians.append(ToArray(H));
  }
  return py::make_tuple(Array(y.size(), y.data()), ToArray(J), hessians);
}

Array MaskOf(const collocation::Mask& mask) { return ToArray(mask.matrix().cast<double>()); }

void BindTape(py::module_& module) {
  py::class_<TapeHandle>(module, "Tape")
      .def(py::init(&MakeTape))
      .def("evaluate", &EvaluateTape)
      .def("masks", [](const TapeHandle& tape) {
        return py::make_tuple(MaskOf(tape.function->JacobianMask()),
                              MaskOf(tape.function->HessianMask()));
      });
}

/// Phases are named by their index: they belong to the problem.
void BindPhases(py::class_<OptimalControlProblem, SharedProblem>* problem) {
  using Problem = OptimalControlProblem;
  problem
      ->def("add_phase",
            [](Problem& self, const std::string& name, int order) {
              self.AddPhase(name, order);
              return self.num_phases() - 1;
            })
      .def("add_coordinate",
           [](Problem& self, int phase, int order, const std::string& name, const Interval& bounds,
              std::optional<double> scale) {
             return self.phase(phase).AddCoordinateOfOrder(order, name, ToBounds(bounds), scale);
           })
      .def("add_control",
           [](Problem& self, int phase, const std::string& name, const Interval& bounds,
              std::optional<double> scale) {
             return self.phase(phase).AddControl(name, ToBounds(bounds), scale);
           })
      .def("rate", [](Problem& self, int phase,
                      const Variable& variable) { return self.phase(phase).Rate(variable); })
      .def("duration", [](Problem& self, int phase) { return self.phase(phase).duration(); })
      .def("time", [](Problem& self, int phase) { return self.phase(phase).time(); })
      .def("share", [](Problem& self, int phase) { return self.phase(phase).share(); })
      .def("set_duration",
           [](Problem& self, int phase, const Interval& bounds) {
             self.phase(phase).SetDuration(ToBounds(bounds));
           })
      .def("set_scale", [](Problem& self, int phase, const Variable& variable,
                           double scale) { self.phase(phase).SetScale(variable, scale); })
      .def("bound",
           [](Problem& self, int phase, const Variable& variable, const Interval& bounds,
              const std::string& at) {
             self.phase(phase).Bound(variable, ToBounds(bounds), AtNamed(at));
           })
      .def("guess",
           [](Problem& self, int phase, const Variable& variable, std::vector<double> values) {
             self.phase(phase).Guess(variable, Sampled(std::move(values)));
           });
}

void BindFunctionsOfPhases(py::class_<OptimalControlProblem, SharedProblem>* problem) {
  using Problem = OptimalControlProblem;
  using Variables = std::vector<Variable>;
  problem
      ->def("set_dynamics",
            [](Problem& self, int phase, const TapeHandle& tape, const Variables& arguments) {
              self.phase(phase).SetDynamics(tape.function, arguments);
            })
      .def("constrain",
           [](Problem& self, int phase, const std::string& name, const TapeHandle& tape,
              const Variables& arguments, const std::vector<Interval>& bounds,
              const std::string& at, const std::vector<double>& scales) {
             self.phase(phase).Constrain(name, tape.function, arguments, ToBounds(bounds),
                                         AtNamed(at), scales);
           })
      .def("add_integral_cost",
           [](Problem& self, int phase, const std::string& name, const TapeHandle& tape,
              const Variables& arguments, double weight) {
             self.phase(phase).AddIntegralCost(name, tape.function, arguments, weight);
           })
      .def("constrain_integral",
           [](Problem& self, int phase, const std::string& name, const TapeHandle& tape,
              const Variables& arguments, const Interval& bounds) {
             self.phase(phase).ConstrainIntegral(name, tape.function, arguments, ToBounds(bounds));
           })
      .def("add_rate_cost", [](Problem& self, int phase, const Variable& control,
                               double weight) { self.phase(phase).AddRateCost(control, weight); })
      .def("bound_rate",
           [](Problem& self, int phase, const Variable& control, const Interval& bounds) {
             self.phase(phase).BoundRate(control, ToBounds(bounds));
           });
}

void BindWhole(py::class_<OptimalControlProblem, SharedProblem>* problem) {
  using Problem = OptimalControlProblem;
  problem
      ->def("add_parameter",
            [](Problem& self, const std::string& name, const Interval& bounds,
               std::optional<double> scale,
               double guess) { return self.AddParameter(name, ToBounds(bounds), scale, guess); })
      .def("join",
           [](Problem& self, const Variable& from, const Variable& to) {
             self.Continue({from, At::kEnd}, {to, At::kStart});
           })
      .def("link",
           [](Problem& self, const std::string& name, const TapeHandle& tape,
              const Instants& arguments, const std::vector<Interval>& bounds) {
             self.Link(name, tape.function, ToInstants(arguments), ToBounds(bounds));
           })
      .def("add_cost",
           [](Problem& self, const std::string& name, const TapeHandle& tape,
              const Instants& arguments,
              double weight) { self.AddCost(name, tape.function, ToInstants(arguments), weight); })
      .def("outline", [](const Problem& self) {
        py::list phases;
        for (int i = 0; i < self.num_phases(); ++i) {
          phases.append(
              py::make_tuple(self.phase(i).name(), self.phase(i).order(), QuantitiesOf(self, i)));
        }
        return phases;
      });
}

/// The problems of the regression suite that need no robot.
void BindNamed(py::module_& module) {
  using experiments::RegressionProblem;
  py::class_<RegressionProblem>(module, "NamedProblem")
      .def_readonly("name", &RegressionProblem::name)
      .def_readonly("source", &RegressionProblem::source)
      .def_readonly("intervals", &RegressionProblem::intervals)
      .def_readonly("mesh_tolerance", &RegressionProblem::mesh_tolerance)
      .def_property_readonly("scheme",
                             [](const RegressionProblem& problem) { return problem.scheme.name; })
      .def_property_readonly("optima",
                             [](const RegressionProblem& problem) {
                               std::vector<std::pair<std::string, double>> optima;
                               for (const experiments::KnownOptimum& optimum : problem.optima) {
                                 optima.emplace_back(optimum.name, optimum.objective);
                               }
                               return optima;
                             })
      .def("build",
           [](const RegressionProblem& problem) { return SharedProblem(problem.build()); });
  module.def("named_problems", [] { return experiments::RegressionProblems(); });
}

}  // namespace

void BindProblems(py::module_& module) {
  py::class_<Variable>(module, "Variable").def_property_readonly("key", [](const Variable& v) {
    return py::make_tuple(static_cast<int>(v.kind), v.phase, v.index, v.order, v.problem);
  });
  BindTape(module);
  py::class_<OptimalControlProblem, SharedProblem> problem(module, "Problem");
  problem.def(py::init<const std::string&>());
  BindPhases(&problem);
  BindFunctionsOfPhases(&problem);
  BindWhole(&problem);
  BindNamed(module);
}

}  // namespace possibility::python
