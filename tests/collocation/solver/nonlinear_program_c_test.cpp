// The C interface of nonlinear programs, with values of C++ and with a solver written in C.
#include "collocation/solver/nonlinear_program_c.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "collocation/solver/program_handle.h"
#include "collocation/study/optimal_control.h"
#include "tests/collocation/solver/newton_in_c.h"
#include "tests/collocation/solver/pendulum_chain.h"
#include "tests/collocation/solver/small_program.h"
#include "tests/collocation/study/neighbouring_problems.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

TEST(NonlinearProgramC, SizesBoundsPatternsAndNamesAreThoseOfTheProgram) {
  PendulumChain chain({.pendulums = 2, .knots = 5});
  possibility_program handle(&chain, chain.Guess());
  const int n = possibility_num_variables(&handle), m = possibility_num_constraints(&handle);
  ASSERT_EQ(n, chain.num_variables());
  ASSERT_EQ(m, chain.num_constraints());
  VectorXd lower(n), upper(n), start(n), row_lower(m), row_upper(m);
  possibility_bounds(&handle, lower.data(), upper.data());
  possibility_constraint_bounds(&handle, row_lower.data(), row_upper.data());
  possibility_starting_point(&handle, start.data());
  EXPECT_EQ(lower, chain.lower());
  EXPECT_EQ(upper, chain.upper());
  EXPECT_EQ(row_lower, chain.constraint_lower());
  EXPECT_EQ(row_upper, chain.constraint_upper());
  EXPECT_EQ(start, chain.Guess());

  std::vector<int> rows(possibility_jacobian_entries(&handle)), columns(rows.size());
  possibility_jacobian_pattern(&handle, rows.data(), columns.data());
  EXPECT_EQ(rows, chain.jacobian_pattern().rows);
  EXPECT_EQ(columns, chain.jacobian_pattern().columns);
  rows.resize(possibility_hessian_entries(&handle));
  columns.resize(rows.size());
  possibility_hessian_pattern(&handle, rows.data(), columns.data());
  EXPECT_EQ(rows, chain.hessian_pattern().rows);
  EXPECT_EQ(columns, chain.hessian_pattern().columns);

  EXPECT_EQ(possibility_variable_name(&handle, 3), chain.VariableName(3));
  EXPECT_EQ(possibility_constraint_name(&handle, 3), chain.ConstraintName(3));
  EXPECT_STREQ(possibility_variable_name(&handle, n), "");
  EXPECT_STREQ(possibility_constraint_name(&handle, -1), "");
}

TEST(NonlinearProgramC, ValuesAndDerivativesAreThoseOfTheProgram) {
  PendulumChain chain({.pendulums = 2, .knots = 5});
  possibility_program handle(&chain, chain.Guess());
  const int n = chain.num_variables(), m = chain.num_constraints();
  const VectorXd x = chain.Guess() + 0.1 * VectorXd::LinSpaced(n, -1, 1);
  const VectorXd multipliers = VectorXd::LinSpaced(m, -1, 2);
  double value = 0;
  EXPECT_EQ(possibility_objective(&handle, x.data(), &value), 0);
  EXPECT_EQ(value, chain.Objective(x));

  const auto expect_same = [](int status, const VectorXd& from_c, const VectorXd& expected) {
    EXPECT_EQ(status, 0);
    EXPECT_EQ(from_c, expected);
  };
  VectorXd c(n), cpp(n);
  chain.Gradient(x, &cpp);
  expect_same(possibility_gradient(&handle, x.data(), c.data()), c, cpp);
  c.resize(m), cpp.resize(m);
  chain.Constraints(x, &cpp);
  expect_same(possibility_constraints(&handle, x.data(), c.data()), c, cpp);
  c.resize(chain.jacobian_pattern().size()), cpp.resize(c.size());
  chain.Jacobian(x, &cpp);
  expect_same(possibility_jacobian(&handle, x.data(), c.data()), c, cpp);
  c.resize(chain.hessian_pattern().size()), cpp.resize(c.size());
  chain.Hessian(x, 0.7, multipliers, &cpp);
  expect_same(possibility_hessian(&handle, x.data(), 0.7, multipliers.data(), c.data()), c, cpp);
}

TEST(NonlinearProgramC, AFailedEvaluationSaysWhyAndWritesNothing) {
  SmallProgram root({{-1, 1}}, [](const std::vector<Hyper>& x) { return Sqrt(x[0]); });
  root.Add(0, 1, [](const std::vector<Hyper>&) -> Hyper {
    throw std::runtime_error("the table ends at 1");
  });
  possibility_program handle(&root, VectorXd::Ones(1));
  const double x = -1;
  double value = 5;
  EXPECT_NE(possibility_objective(&handle, &x, &value), 0);
  EXPECT_STREQ(possibility_error(&handle), "the objective is not finite");
  EXPECT_NE(possibility_constraints(&handle, &x, &value), 0);
  EXPECT_STREQ(possibility_error(&handle), "a constraint: the table ends at 1");
  EXPECT_EQ(value, 5);
}

TEST(NonlinearProgramC, AStartingPointOfAnotherSizeIsRefused) {
  SmallProgram bowl({{-1, 1}}, [](const std::vector<Hyper>& x) { return x[0] * x[0]; });
  EXPECT_EQ(MessageOf([&] { possibility_program(&bowl, VectorXd::Ones(2)); }),
            "a starting point of 2 numbers for 1 variables");
}

TEST(NonlinearProgramC, ASolverInCSolvesATranscribedProblem) {
  const auto problem = BlockMove(1);
  Transcription program(*problem, HermiteSimpson(), {UniformMesh(8)});
  possibility_program handle(&program, program.InitialGuess());
  VectorXd solution(program.num_variables());
  ASSERT_EQ(newton_in_c(&handle, solution.data()), 0) << possibility_error(&handle);
  EXPECT_NEAR(program.Objective(solution), 12, 1e-9);
  EXPECT_NEAR(program.TrajectoryOf(solution).Value(problem->phase(0).Coordinate(0), 0.25), 0.15625,
              1e-10);
}

}  // namespace
}  // namespace possibility::collocation
