#include "dynamics/ode/dense_linear_solver.h"

#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/LU>
#include <exception>

namespace possibility::dynamics {
namespace {

// SUNDIALS calls these functions from C: no exception may leave them. Negative: unrecoverable.
constexpr int kFailed = -1;

struct Factors {
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  bool is_regular = false;
};

Factors* FactorsOf(SUNLinearSolver solver) { return static_cast<Factors*>(solver->content); }

SUNLinearSolver_Type TypeOf(SUNLinearSolver /*solver*/) noexcept { return SUNLINEARSOLVER_DIRECT; }

int Setup(SUNLinearSolver solver, SUNMatrix matrix) noexcept {
  try {
    Factors* factors = FactorsOf(solver);
    factors->lu.compute(Eigen::Map<const Eigen::MatrixXd>(
        SUNDenseMatrix_Data(matrix), SUNDenseMatrix_Rows(matrix), SUNDenseMatrix_Columns(matrix)));
    factors->is_regular = (factors->lu.matrixLU().diagonal().array() != 0).all();
    return factors->is_regular ? SUNLS_SUCCESS : SUNLS_LUFACT_FAIL;
  } catch (const std::exception&) {
    return kFailed;
  }
}

int Solve(SUNLinearSolver solver, SUNMatrix /*matrix*/, N_Vector x, N_Vector b,
          realtype /*tolerance*/) noexcept {
  try {
    const Factors* factors = FactorsOf(solver);
    if (!factors->is_regular) return kFailed;
    const Eigen::Index size = factors->lu.rows();
    const Eigen::Map<const Eigen::VectorXd> right(N_VGetArrayPointer(b), size);
    Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(x), size) = factors->lu.solve(right);
    return SUNLS_SUCCESS;
  } catch (const std::exception&) {
    return kFailed;
  }
}

int Free(SUNLinearSolver solver) noexcept {
  delete FactorsOf(solver);
  solver->content = nullptr;
  SUNLinSolFreeEmpty(solver);
  return SUNLS_SUCCESS;
}

}  // namespace

SUNLinearSolver MakeDenseLinearSolver(SUNContext context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context);
  if (solver == nullptr) return nullptr;
  solver->ops->gettype = &TypeOf;
  solver->ops->setup = &Setup;
  solver->ops->solve = &Solve;
  solver->ops->free = &Free;
  solver->content = new (std::nothrow) Factors;
  if (solver->content != nullptr) return solver;
  SUNLinSolFreeEmpty(solver);
  return nullptr;
}

}  // namespace possibility::dynamics
