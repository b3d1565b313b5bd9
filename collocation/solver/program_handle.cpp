#include "collocation/solver/program_handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

namespace {

using Eigen::VectorXd;
using possibility::collocation::SparsityPattern;

void Copy(const VectorXd& from, double* to) { std::copy(from.begin(), from.end(), to); }

void Copy(const SparsityPattern& pattern, int* rows, int* columns) {
  std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
  std::copy(pattern.columns.begin(), pattern.columns.end(), columns);
}

/// Calls function(x, &values), which fills `size` values. No exception leaves: callers know none.
template <typename Function>
int Evaluate(possibility_program* handle, const char* what, const double* x, int size, double* out,
             const Function& function) {
  try {
    const VectorXd point = Eigen::Map<const VectorXd>(x, handle->program->num_variables());
    VectorXd values(size);
    function(point, &values);
    if (values.allFinite()) {
      Copy(values, out);
      return 0;
    }
    handle->error = fmt::format("{} is not finite", what);
  } catch (const std::exception& error) {
    handle->error = fmt::format("{}: {}", what, error.what());
  } catch (...) {
    handle->error = fmt::format("{}: unknown exception", what);
  }
  return 1;
}

template <typename Name>
const char* NameOf(possibility_program* handle, int index, int size, const Name& name) {
  handle->name = index >= 0 && index < size ? name(index) : std::string();
  return handle->name.c_str();
}

}  // namespace

possibility_program::possibility_program(possibility::collocation::NonlinearProgram* the_program,
                                         Eigen::VectorXd start)
    : program(the_program), starting_point(std::move(start)) {
  if (starting_point.size() != program->num_variables()) {
    throw std::invalid_argument(fmt::format("a starting point of {} numbers for {} variables",
                                            starting_point.size(), program->num_variables()));
  }
}

int possibility_num_variables(const possibility_program* handle) {
  return handle->program->num_variables();
}

int possibility_num_constraints(const possibility_program* handle) {
  return handle->program->num_constraints();
}

void possibility_bounds(const possibility_program* handle, double* lower, double* upper) {
  Copy(handle->program->lower(), lower);
  Copy(handle->program->upper(), upper);
}

void possibility_constraint_bounds(const possibility_program* handle, double* lower,
                                   double* upper) {
  Copy(handle->program->constraint_lower(), lower);
  Copy(handle->program->constraint_upper(), upper);
}

void possibility_starting_point(const possibility_program* handle, double* x) {
  Copy(handle->starting_point, x);
}

int possibility_jacobian_entries(const possibility_program* handle) {
  return handle->program->jacobian_pattern().size();
}

void possibility_jacobian_pattern(const possibility_program* handle, int* rows, int* columns) {
  Copy(handle->program->jacobian_pattern(), rows, columns);
}

int possibility_hessian_entries(const possibility_program* handle) {
  return handle->program->hessian_pattern().size();
}

void possibility_hessian_pattern(const possibility_program* handle, int* rows, int* columns) {
  Copy(handle->program->hessian_pattern(), rows, columns);
}

int possibility_objective(possibility_program* handle, const double* x, double* value) {
  return Evaluate(handle, "the objective", x, 1, value, [&](const VectorXd& at, VectorXd* to) {
    (*to)[0] = handle->program->Objective(at);
  });
}

int possibility_gradient(possibility_program* handle, const double* x, double* gradient) {
  return Evaluate(handle, "the gradient", x, possibility_num_variables(handle), gradient,
                  [&](const VectorXd& at, VectorXd* to) { handle->program->Gradient(at, to); });
}

int possibility_constraints(possibility_program* handle, const double* x, double* g) {
  return Evaluate(handle, "a constraint", x, possibility_num_constraints(handle), g,
                  [&](const VectorXd& at, VectorXd* to) { handle->program->Constraints(at, to); });
}

int possibility_jacobian(possibility_program* handle, const double* x, double* values) {
  return Evaluate(handle, "the Jacobian", x, possibility_jacobian_entries(handle), values,
                  [&](const VectorXd& at, VectorXd* to) { handle->program->Jacobian(at, to); });
}

int possibility_hessian(possibility_program* handle, const double* x, double objective_factor,
                        const double* multipliers, double* values) {
  return Evaluate(handle, "the Hessian", x, possibility_hessian_entries(handle), values,
                  [&](const VectorXd& at, VectorXd* to) {
                    const VectorXd of_rows =
                        Eigen::Map<const VectorXd>(multipliers, handle->program->num_constraints());
                    handle->program->Hessian(at, objective_factor, of_rows, to);
                  });
}

const char* possibility_error(possibility_program* handle) { return handle->error.c_str(); }

const char* possibility_variable_name(possibility_program* handle, int variable) {
  return NameOf(handle, variable, handle->program->num_variables(),
                [&](int i) { return handle->program->VariableName(i); });
}

const char* possibility_constraint_name(possibility_program* handle, int constraint) {
  return NameOf(handle, constraint, handle->program->num_constraints(),
                [&](int i) { return handle->program->ConstraintName(i); });
}
