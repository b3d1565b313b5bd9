#include "dynamics/ode/newton_linear_solver.h"

#include <exception>
#include <new>

#include "dynamics/ode/state_vector.h"

namespace possibility::dynamics {
namespace {

// SUNDIALS calls these functions from C: no exception may leave them. Negative: unrecoverable.
constexpr int kFailed = -1;

struct Content {
  NewtonMatrix* matrix = nullptr;
  double gamma = 0;
  bool is_regular = false;
};

Content* ContentOf(SUNLinearSolver solver) { return static_cast<Content*>(solver->content); }

SUNLinearSolver_Type TypeOf(SUNLinearSolver /*solver*/) noexcept { return SUNLINEARSOLVER_DIRECT; }

int Setup(SUNLinearSolver solver, SUNMatrix /*matrix*/) noexcept {
  try {
    Content* content = ContentOf(solver);
    content->is_regular = content->matrix->Factor(content->gamma);
    return content->is_regular ? SUNLS_SUCCESS : SUNLS_LUFACT_FAIL;
  } catch (const std::exception&) {
    return kFailed;
  }
}

int Solve(SUNLinearSolver solver, SUNMatrix /*matrix*/, N_Vector x, N_Vector b,
          realtype /*tolerance*/) noexcept {
  try {
    const Content* content = ContentOf(solver);
    if (!content->is_regular) return kFailed;
    auto solution = AsVector(x);
    solution = AsVector(b);
    content->matrix->Solve(solution);
    return SUNLS_SUCCESS;
  } catch (const std::exception&) {
    return kFailed;
  }
}

int Free(SUNLinearSolver solver) noexcept {
  delete ContentOf(solver);
  solver->content = nullptr;
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

}  // namespace

SUNLinearSolver MakeNewtonLinearSolver(NewtonMatrix* matrix, SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->ops->gettype = &TypeOf;
  solver->ops->setup = &Setup;
  solver->ops->solve = &Solve;
  solver->ops->free = &Free;
  solver->content = new (std::nothrow) Content{matrix};
  if (solver->content != nullptr) return solver;
  SUNLinSolFreeEmpty(solver);
  return nullptr;
}

void SetGamma(SUNLinearSolver solver, double gamma) { ContentOf(solver)->gamma = gamma; }

}  // namespace possibility::dynamics
