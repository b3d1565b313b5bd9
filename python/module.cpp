#include "python/bindings.h"
#include "python/interruptible.h"

namespace possibility::python {

PYBIND11_MODULE(_possibility, module) {
  BindInputs(module);
  BindPlans(module);
  BindPlanning(module);
  BindFiles(module);
  BindProblems(module);
  BindSolutions(module);
  module.def("await_abandoned_work", &AwaitAbandonedWork);
}

}  // namespace possibility::python
