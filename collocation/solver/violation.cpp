#include "collocation/solver/violation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace possibility::collocation {

using Eigen::VectorXd;

Violation WorstViolation(const NonlinearProgram& program, const VectorXd& x, const VectorXd& g) {
  Violation worst;
  auto look = [&](const VectorXd& value, const VectorXd& lower, const VectorXd& upper,
                  const std::function<std::string(int)>& name,
                  const std::function<double(int)>& scale) {
    for (int i = 0; i < value.size(); ++i) {
      const double size = std::max(lower[i] - value[i], value[i] - upper[i]);
      if (size > worst.size) worst = {size, size * scale(i), name(i)};
    }
  };
  look(
      x, program.lower(), program.upper(),
      [&](int i) { return fmt::format("variable '{}'", program.VariableName(i)); },
      [&](int i) { return program.VariableScale(i); });
  look(
      g, program.constraint_lower(), program.constraint_upper(),
      [&](int i) { return fmt::format("constraint '{}'", program.ConstraintName(i)); },
      [&](int i) { return program.ConstraintScale(i); });
  return worst;
}

Violation EvaluateResult(NonlinearProgram* program, SolverResult* result) {
  result->constraints = VectorXd::Constant(program->num_constraints(), std::nan(""));
  result->objective = std::nan("");
  try {
    result->objective = program->Objective(result->x);
    program->Constraints(result->x, &result->constraints);
  } catch (const std::runtime_error&) {  // a function is undefined at this iterate
  }
  Violation worst = WorstViolation(*program, result->x, result->constraints);
  result->worst_violation = worst.size;
  return worst;
}

}  // namespace possibility::collocation
