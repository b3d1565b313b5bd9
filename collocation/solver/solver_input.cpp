#include "collocation/solver/solver_input.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

void CheckBounds(const VectorXd& lower, const VectorXd& upper, int size, const char* what,
                 const std::function<std::string(int)>& name) {
  if (lower.size() != size || upper.size() != size) {
    throw std::invalid_argument(fmt::format("{} {}s but {} lower and {} upper bounds", size, what,
                                            lower.size(), upper.size()));
  }
  for (int i = 0; i < size; ++i) {
    const bool possible = lower[i] <= upper[i] && lower[i] < HUGE_VAL && upper[i] > -HUGE_VAL;
    if (possible) continue;
    throw std::invalid_argument(fmt::format("{} '{}': no value is at least {} and at most {}", what,
                                            name(i), lower[i], upper[i]));
  }
}

void CheckPattern(const SparsityPattern& pattern, int rows, int columns, const char* what) {
  if (pattern.rows.size() != pattern.columns.size()) {
    throw std::invalid_argument(fmt::format("the pattern of the {} has {} rows but {} columns",
                                            what, pattern.rows.size(), pattern.columns.size()));
  }
  for (int k = 0; k < pattern.size(); ++k) {
    const int row = pattern.rows[k], column = pattern.columns[k];
    if (row >= 0 && row < rows && column >= 0 && column < columns) continue;
    throw std::invalid_argument(fmt::format("the {} has an entry ({}, {}) but is {} x {}", what,
                                            row, column, rows, columns));
  }
}

void CheckGuessPart(const VectorXd& part, int size, const char* what,
                    const std::function<std::string(int)>& name) {
  if (part.size() != size) {
    throw std::invalid_argument(
        fmt::format("the guess has {} {} instead of {}", part.size(), what, size));
  }
  for (int i = 0; i < size; ++i) {
    if (std::isfinite(part[i])) continue;
    throw std::invalid_argument(
        fmt::format("the guess of the {}: '{}' is {}", what, name(i), part[i]));
  }
}

}  // namespace

bool IsWarm(const SolverGuess& guess) {
  return guess.constraint_multipliers.size() + guess.lower_multipliers.size() +
             guess.upper_multipliers.size() >
         0;
}

void CheckSolverInput(const NonlinearProgram& program, const SolverGuess& guess) {
  const int n = program.num_variables(), m = program.num_constraints();
  if (n == 0) throw std::invalid_argument("the program has no variables");
  const auto variable = [&](int i) { return program.VariableName(i); };
  const auto constraint = [&](int i) { return program.ConstraintName(i); };
  CheckBounds(program.lower(), program.upper(), n, "variable", variable);
  CheckBounds(program.constraint_lower(), program.constraint_upper(), m, "constraint", constraint);
  CheckPattern(program.jacobian_pattern(), m, n, "Jacobian");
  CheckPattern(program.hessian_pattern(), n, n, "Hessian");
  CheckGuessPart(guess.x, n, "variables", variable);
  if (IsWarm(guess)) {
    CheckGuessPart(guess.constraint_multipliers, m, "constraint multipliers", constraint);
    CheckGuessPart(guess.lower_multipliers, n, "lower multipliers", variable);
    CheckGuessPart(guess.upper_multipliers, n, "upper multipliers", variable);
  }
}

}  // namespace possibility::collocation
