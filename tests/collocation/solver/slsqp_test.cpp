// A second solver behind NonlinearSolver: SLSQP, which shares no method with Ipopt.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "collocation/study/optimal_control.h"
#include "experiments/peers/slsqp_solver.h"
#include "tests/collocation/solver/pendulum_chain.h"
#include "tests/collocation/solver/quadratic_program.h"
#include "tests/collocation/solver/small_program.h"
#include "tests/collocation/study/neighbouring_problems.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using experiments::SlsqpSolver;
using Row = std::vector<Hyper>;

SolverResult SolveWithSlsqp(NonlinearProgram* program, const VectorXd& start,
                            const SolverOptions& options = {},
                            const CancellationToken& cancellation = {}) {
  return SlsqpSolver().Solve(program, {start, {}, {}, {}}, options, cancellation, {});
}

/// Hock & Schittkowski 71: bounds, an equality and an inequality.
SmallProgram HockSchittkowski71() {
  SmallProgram program({{1, 5}, {1, 5}, {1, 5}, {1, 5}},
                       [](const Row& x) { return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; });
  program.Add(25, kUnbounded, [](const Row& x) { return x[0] * x[1] * x[2] * x[3]; });
  program.Add(40, 40,
              [](const Row& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]; });
  return program;
}

TEST(Slsqp, MeetsATextbookOptimumWithItsMultipliers) {
  SmallProgram program = HockSchittkowski71();
  const VectorXd start = (VectorXd(4) << 1, 5, 5, 1).finished();
  const SolverResult ours = SolveWithSlsqp(&program, start);
  const SolverResult ipopt = Solve(&program, {start, {}, {}, {}});
  ASSERT_TRUE(ours.succeeded()) << ours.message;
  EXPECT_NEAR(ours.objective, 17.0140173, 1e-6);
  EXPECT_LT((ours.x - ipopt.x).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_LT((ours.constraint_multipliers - ipopt.constraint_multipliers).norm(), 1e-4);
  EXPECT_NEAR(ours.lower_multipliers[0], ipopt.lower_multipliers[0], 1e-4);
  EXPECT_LT(ours.worst_violation, 1e-8);
  EXPECT_GT(ours.history.size(), 3u);
  EXPECT_EQ(ours.evaluations.hessian, 0);
}

TEST(Slsqp, FixedVariablesStayFixed) {
  SmallProgram program({{-5, 5}, {2, 2}, {-5, 5}},
                       [](const Row& x) { return (x[0] - x[1]) * (x[0] - x[1]) + x[2] * x[2]; });
  program.Add(1, 1, [](const Row& x) { return x[2] + x[1] - x[0]; });
  const SolverResult result = SolveWithSlsqp(&program, VectorXd::Zero(3));
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_EQ(result.x[1], 2);
  EXPECT_NEAR(result.x[0], 1.5, 1e-7);
  EXPECT_NEAR(result.x[2], 0.5, 1e-7);
}

TEST(Slsqp, AgreesWithIpoptOnRandomConvexPrograms) {
  std::mt19937 random(4);
  for (int sample = 0; sample < 20; ++sample) {
    const int n = 10, m = 4;
    const MatrixXd noise = NormalMatrix(n, n, &random);
    QuadraticProgram program(noise * noise.transpose() + MatrixXd::Identity(n, n),
                             5 * NormalMatrix(n, 1, &random), NormalMatrix(m, n, &random));
    program.mutable_lower().setConstant(-0.5);
    program.mutable_upper().setConstant(0.5);
    program.mutable_row_lower() << 0, -0.2, -kUnbounded, -3;
    program.mutable_row_upper() << 0, 0.2, 0.1, 3;
    const SolverResult ours = SolveWithSlsqp(&program, VectorXd::Zero(n));
    const SolverResult ipopt = Solve(&program, {VectorXd::Zero(n), {}, {}, {}});
    ASSERT_TRUE(ours.succeeded()) << sample << ": " << ours.message;
    EXPECT_NEAR(ours.objective, ipopt.objective, 1e-6 * std::abs(ipopt.objective));
    EXPECT_LT((ours.x - ipopt.x).lpNorm<Eigen::Infinity>(), 1e-5);
  }
}

TEST(Slsqp, SolvesATranscribedProblemAndItsFinerMeshes) {
  const auto problem = BlockMove(1, 5.5);
  const Variable x = problem->phase(0).Coordinate(0);
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {8};
  options.mesh_tolerance = 1e-3;
  options.second_order_check = true;
  const OptimalControlResult ipopt = SolveOptimalControl(*problem, options);
  options.nonlinear_solver = &SlsqpSolver();
  const OptimalControlResult ours = SolveOptimalControl(*problem, options);
  ASSERT_TRUE(ours.succeeded()) << ours.message;
  EXPECT_GT(ours.refinements, 0);
  EXPECT_EQ(ours.refinements, ipopt.refinements);
  EXPECT_NEAR(ours.objective, ipopt.objective, 1e-6);
  EXPECT_NEAR(ours.Value(x, 0.25), ipopt.Value(x, 0.25), 1e-6);
  EXPECT_EQ(ours.stationary_point, StationaryPoint::kMinimum);
}

TEST(Slsqp, RefusesLargeProgramsAndIpoptsOptions) {
  QuadraticProgram large(MatrixXd::Zero(2001, 1), VectorXd::Zero(2001), MatrixXd(0, 2001));
  EXPECT_EQ(MessageOf([&] { SolveWithSlsqp(&large, VectorXd::Zero(2001)); }),
            "SLSQP has dense matrices: 2001 variables are more than 2000");
  SmallProgram program = HockSchittkowski71();
  SolverOptions options;
  options.ipopt = {{"mu_strategy", "monotone"}};
  EXPECT_EQ(MessageOf([&] { SolveWithSlsqp(&program, VectorXd::Ones(4), options); }),
            "SLSQP has no option 'mu_strategy', it is Ipopt's");
}

TEST(Slsqp, StopsWhenCancelledOrOutOfTimeOrIterations) {
  PendulumChain chain({.pendulums = 2, .knots = 20, .target = 0.5});
  int questions = 0;
  const CancellationToken cancellation([&] { return ++questions < 20; });
  const SolverResult cancelled = SolveWithSlsqp(&chain, chain.Guess(), {}, cancellation);
  EXPECT_EQ(cancelled.status, SolverStatus::kCancelled);
  EXPECT_EQ(questions, 20);  // nothing is asked after it

  SolverOptions options;
  options.max_iterations = 3;
  const SolverResult limited = SolveWithSlsqp(&chain, chain.Guess(), options);
  EXPECT_EQ(limited.status, SolverStatus::kIterationLimit) << limited.message;
  EXPECT_EQ(limited.history.back().number, 3);

  options.max_iterations = 1000;
  options.time_limit = 1e-4;
  EXPECT_EQ(SolveWithSlsqp(&chain, chain.Guess(), options).status, SolverStatus::kTimeLimit);
}

TEST(Slsqp, NamesWhatIsNotANumberAtTheStart) {
  SmallProgram root({{-1, 1}}, [](const Row& x) { return Sqrt(x[0]); });
  const SolverResult result = SolveWithSlsqp(&root, VectorXd::Constant(1, -0.5));
  EXPECT_EQ(result.status, SolverStatus::kInvalidNumber);
  EXPECT_EQ(result.message.find("the objective is "), 0u) << result.message;

  SmallProgram bowl({{-1, 1}}, [](const Row& x) { return x[0] * x[0]; });
  bowl.Add(0, 1, [](const Row& x) { return Log(x[0]); });
  const SolverResult other = SolveWithSlsqp(&bowl, VectorXd::Constant(1, -0.5));
  EXPECT_EQ(other.status, SolverStatus::kInvalidNumber);
  EXPECT_EQ(other.message.find("constraint 'g1' is "), 0u) << other.message;
}

TEST(Slsqp, ShortensItsStepWhereAFunctionIsUndefined) {
  SmallProgram barrier({{-kUnbounded, kUnbounded}},
                       [](const Row& x) { return 10.0 * x[0] - Log(x[0]); });
  const SolverResult result = SolveWithSlsqp(&barrier, VectorXd::Ones(1));
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.x[0], 0.1, 1e-6);
}

TEST(Slsqp, AnExceptionOfTheProgramComesOutUnchanged) {
  int calls = 0;
  SmallProgram broken({{-1, 1}}, [&calls](const Row& x) -> Hyper {
    if (++calls > 2) throw std::logic_error("broken");
    return x[0] * x[0];
  });
  EXPECT_EQ(MessageOf<std::logic_error>([&] { SolveWithSlsqp(&broken, VectorXd::Ones(1)); }),
            "broken");
}

TEST(Slsqp, SaysWhatIsViolatedIfNothingIsFeasible) {
  SmallProgram impossible({{-1, 1}}, [](const Row& x) { return x[0] * x[0]; });
  impossible.Add(4, 5, [](const Row& x) { return x[0] * x[0]; });
  const SolverResult result = SolveWithSlsqp(&impossible, VectorXd::Constant(1, 0.5));
  EXPECT_FALSE(result.succeeded());
  EXPECT_NE(result.message.find("constraint 'g1' is off by 3"), std::string::npos)
      << result.message;
}

TEST(Slsqp, IsDeterministic) {
  PendulumChain chain({.pendulums = 2, .knots = 12, .target = 0.5});
  const SolverResult first = SolveWithSlsqp(&chain, chain.Guess());
  const SolverResult second = SolveWithSlsqp(&chain, chain.Guess());
  EXPECT_TRUE(first.succeeded()) << first.message;
  EXPECT_EQ(first.x, second.x);
}

}  // namespace
}  // namespace possibility::collocation
