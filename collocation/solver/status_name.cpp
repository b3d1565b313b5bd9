#include "collocation/solver/status_name.h"

namespace possibility::collocation {

std::string StatusName(SolverStatus status) {
  switch (status) {
    case SolverStatus::kSolved:
      return "solved";
    case SolverStatus::kAcceptable:
      return "acceptable";
    case SolverStatus::kInfeasible:
      return "infeasible";
    case SolverStatus::kUnbounded:
      return "unbounded";
    case SolverStatus::kIterationLimit:
      return "iteration_limit";
    case SolverStatus::kTimeLimit:
      return "time_limit";
    case SolverStatus::kCancelled:
      return "cancelled";
    case SolverStatus::kInvalidNumber:
      return "invalid_number";
    case SolverStatus::kWrongDerivative:
      return "wrong_derivative";
    case SolverStatus::kFailed:
      break;
  }
  return "failed";
}

}  // namespace possibility::collocation
