#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "experiments/command/loaded_plan.h"

namespace possibility::python {

/// A plan with its robot and scenario, shared with the threads that work on it.
using SharedPlan = std::shared_ptr<const experiments::LoadedPlan>;

// Each adds a part of the extension module, whose only user is the package beside it.
void BindInputs(pybind11::module_& module);    ///< robots, scenarios
void BindPlans(pybind11::module_& module);     ///< plans and their arrays
void BindPlanning(pybind11::module_& module);  ///< planning, verification, rollouts
void BindFiles(pybind11::module_& module);     ///< exports and pages
void BindProblems(pybind11::module_& module);  ///< problems of optimal control
void BindSolutions(pybind11::module_& module);

}  // namespace possibility::python
