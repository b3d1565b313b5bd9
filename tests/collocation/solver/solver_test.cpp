#include "collocation/solver/solver.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/collocation/solver/pendulum_chain.h"
#include "tests/collocation/solver/small_program.h"

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;
using X = std::vector<Hyper>;

VectorXd Vector(std::initializer_list<double> values) {
  VectorXd vector(static_cast<int>(values.size()));
  std::copy(values.begin(), values.end(), vector.begin());
  return vector;
}

/// A textbook problem, its usual start and its known optimum.
struct Textbook {
  std::string name;
  SmallProgram program;
  VectorXd start;
  double optimum;
};

std::vector<std::pair<double, double>> Boxes(int n, double lower, double upper) {
  return std::vector<std::pair<double, double>>(n, {lower, upper});
}

/// Hock & Schittkowski, Test Examples for Nonlinear Programming Codes (1981), by their numbers.
std::vector<Textbook> Textbooks() {
  std::vector<Textbook> all;
  all.push_back({"HS001 Rosenbrock with a bound",
                 SmallProgram({{-kUnbounded, kUnbounded}, {-1.5, kUnbounded}},
                              [](const X& x) {
                                const Hyper a = x[1] - x[0] * x[0], b = 1.0 - x[0];
                                return 100.0 * (a * a) + b * b;
                              }),
                 Vector({-2, 1}), 0});
  all.push_back({"HS006",
                 SmallProgram(Boxes(2, -kUnbounded, kUnbounded),
                              [](const X& x) { return (1.0 - x[0]) * (1.0 - x[0]); }),
                 Vector({-1.2, 1}), 0});
  all.back().program.Add(0, 0, [](const X& x) { return 10.0 * (x[1] - x[0] * x[0]); });
  all.push_back({"HS015 Rosenbrock constrained",
                 SmallProgram({{-kUnbounded, 0.5}, {-kUnbounded, kUnbounded}},
                              [](const X& x) {
                                const Hyper a = x[1] - x[0] * x[0], b = 1.0 - x[0];
                                return 100.0 * (a * a) + b * b;
                              }),
                 Vector({-2, 1}), 306.5});
  all.back()
      .program.Add(1, kUnbounded, [](const X& x) { return x[0] * x[1]; })
      .Add(0, kUnbounded, [](const X& x) { return x[0] + x[1] * x[1]; });
  all.push_back({"HS035",
                 SmallProgram(Boxes(3, 0, kUnbounded),
                              [](const X& x) {
                                return 9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2] +
                                       2.0 * (x[0] * x[0]) + 2.0 * (x[1] * x[1]) + x[2] * x[2] +
                                       2.0 * (x[0] * x[1]) + 2.0 * (x[0] * x[2]);
                              }),
                 Vector({0.5, 0.5, 0.5}), 1.0 / 9});
  all.back().program.Add(-kUnbounded, 3, [](const X& x) { return x[0] + x[1] + 2.0 * x[2]; });
  all.push_back({"HS071",
                 SmallProgram(Boxes(4, 1, 5),
                              [](const X& x) { return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; }),
                 Vector({1, 5, 5, 1}), 17.0140172892});
  all.back()
      .program.Add(25, kUnbounded, [](const X& x) { return x[0] * x[1] * x[2] * x[3]; })
      .Add(40, 40,
           [](const X& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]; });
  all.push_back({"HS106 heat exchangers, badly scaled",
                 SmallProgram({{100, 1e4},
                               {1000, 1e4},
                               {1000, 1e4},
                               {10, 1000},
                               {10, 1000},
                               {10, 1000},
                               {10, 1000},
                               {10, 1000}},
                              [](const X& x) { return x[0] + x[1] + x[2]; }),
                 Vector({5000, 5000, 5000, 200, 350, 150, 225, 425}), 7049.24802053});
  all.back()
      .program.Add(-1, kUnbounded, [](const X& x) { return -0.0025 * (x[3] + x[5]); })
      .Add(-1, kUnbounded, [](const X& x) { return -0.0025 * (x[4] + x[6] - x[3]); })
      .Add(-1, kUnbounded, [](const X& x) { return -0.01 * (x[7] - x[4]); })
      .Add(-83333.333, kUnbounded,
           [](const X& x) { return x[0] * x[5] - 833.33252 * x[3] - 100.0 * x[0]; })
      .Add(0, kUnbounded,
           [](const X& x) { return x[1] * x[6] - 1250.0 * x[4] - x[1] * x[3] + 1250.0 * x[3]; })
      .Add(1250000, kUnbounded,
           [](const X& x) { return x[2] * x[7] - x[2] * x[4] + 2500.0 * x[4]; });
  return all;
}

SolverGuess StartAt(const VectorXd& x) { return {x, {}, {}, {}}; }

TEST(Solver, FindsTheKnownOptimaOfTextbooks) {
  for (Textbook& textbook : Textbooks()) {
    for (const auto mode : {HessianMode::kExact, HessianMode::kLimitedMemory}) {
      SCOPED_TRACE(textbook.name + (mode == HessianMode::kExact ? "" : ", limited memory"));
      SolverOptions options;
      options.hessian = mode;
      std::vector<size_t> iterations;
      for (const auto linear : {LinearSolver::kSparseLdlt, LinearSolver::kMumps}) {
        options.linear_solver = linear;
        const SolverResult result = Solve(&textbook.program, StartAt(textbook.start), options);
        EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
        EXPECT_NEAR(result.objective, textbook.optimum, 1e-7 * (1 + textbook.optimum));
        EXPECT_LE(result.worst_violation, 1e-8);
        EXPECT_EQ(result.evaluations.hessian > 0, mode == HessianMode::kExact);
        iterations.push_back(result.history.size());
      }
      // Rounding may lengthen the iterations, but must not change the optimum.
      EXPECT_LE(iterations[0], 2 * iterations[1] + 5);
      EXPECT_LE(iterations[1], 2 * iterations[0] + 5);
    }
  }
}

TEST(Solver, MultipliersBalanceTheGradient) {
  for (Textbook& textbook : Textbooks()) {
    SCOPED_TRACE(textbook.name);
    SmallProgram& program = textbook.program;
    const SolverResult result = Solve(&program, StartAt(textbook.start));
    ASSERT_TRUE(result.succeeded());
    const int n = program.num_variables(), m = program.num_constraints();
    VectorXd gradient(n), jacobian(n * m);
    program.Gradient(result.x, &gradient);
    program.Jacobian(result.x, &jacobian);
    VectorXd balance = gradient - result.lower_multipliers + result.upper_multipliers;
    for (int i = 0; i < m; ++i) {
      balance += result.constraint_multipliers[i] * jacobian.segment(i * n, n);
    }
    EXPECT_LT(balance.lpNorm<Eigen::Infinity>(), 1e-6 * (1 + gradient.lpNorm<Eigen::Infinity>()));
  }
}

TEST(Solver, BothLinearSolversAgreeOnASparseProgram) {
  PendulumChain::Settings settings;
  settings.pendulums = 2;
  settings.knots = 25;
  settings.target = 0.5;
  PendulumChain program(settings);
  SolverOptions options;
  const SolverResult ours = Solve(&program, StartAt(program.Guess()), options);
  options.linear_solver = LinearSolver::kMumps;
  const SolverResult mumps = Solve(&program, StartAt(program.Guess()), options);
  ASSERT_EQ(ours.status, SolverStatus::kSolved) << ours.message;
  ASSERT_EQ(mumps.status, SolverStatus::kSolved) << mumps.message;
  EXPECT_NEAR(ours.objective, mumps.objective, 1e-6 * mumps.objective);
  EXPECT_LE(ours.worst_violation, 1e-8);
  EXPECT_LE(ours.history.size(), mumps.history.size() + 5);
  EXPECT_LE(mumps.history.size(), ours.history.size() + 5);
}

TEST(Solver, FixedVariablesKeepTheirValues) {
  SmallProgram program({{2, 2}, {-kUnbounded, kUnbounded}, {3, 3}},
                       [](const X& x) { return (x[1] - x[0] * x[2]) * (x[1] - x[0] * x[2]); });
  program.Add(-kUnbounded, 5, [](const X& x) { return x[1]; });
  const SolverResult result = Solve(&program, StartAt(Vector({0, 0, 0})));
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
  EXPECT_EQ(result.x[0], 2);
  EXPECT_EQ(result.x[2], 3);
  EXPECT_NEAR(result.x[1], 5, 1e-7);
  EXPECT_NEAR(result.objective, 1, 1e-6);
}

TEST(Solver, AProgramWithAllVariablesFixedIsSolvedOrInfeasible) {
  SmallProgram program(Boxes(2, 1, 1), [](const X& x) { return x[0] + x[1]; });
  program.Add(2, 2, [](const X& x) { return x[0] + x[1]; });
  SolverResult result = Solve(&program, StartAt(Vector({0, 0})));
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
  EXPECT_EQ(result.x, Vector({1, 1}));
  EXPECT_EQ(result.objective, 2);
  program.Add(5, kUnbounded, [](const X& x) { return x[0]; });
  result = Solve(&program, StartAt(Vector({0, 0})));
  EXPECT_EQ(result.status, SolverStatus::kInfeasible);
  EXPECT_NE(result.message.find("'g2' is off by 4"), std::string::npos) << result.message;
}

TEST(Solver, ProgramsWithDependentConstraintsAreSolved) {
  SmallProgram program(Boxes(3, -kUnbounded, kUnbounded),
                       [](const X& x) { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; });
  for (const double factor : {1.0, -2.0}) {
    program.Add(factor * 3, factor * 3,
                [factor](const X& x) { return factor * (x[0] + x[1] + x[2]); });
  }
  const SolverResult result = Solve(&program, StartAt(Vector({5, -1, 0})));
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
  EXPECT_NEAR(result.objective, 3, 1e-7);
}

TEST(Solver, InfeasibleProgramsNameTheConstraint) {
  SmallProgram program(Boxes(2, -10, 10), [](const X& x) { return x[0] + x[1]; });
  program.Add(-kUnbounded, 1, [](const X& x) { return x[0] * x[0] + x[1] * x[1]; })
      .Add(4, kUnbounded, [](const X& x) { return x[0]; });
  const SolverResult result = Solve(&program, StartAt(Vector({0, 0})));
  EXPECT_EQ(result.status, SolverStatus::kInfeasible) << result.message;
  EXPECT_GT(result.worst_violation, 0.5);
  EXPECT_NE(result.message.find("constraint 'g"), std::string::npos) << result.message;
  EXPECT_FALSE(result.succeeded());
}

TEST(Solver, UnboundedProgramsNameTheVariable) {
  SmallProgram program(Boxes(2, -kUnbounded, kUnbounded),
                       [](const X& x) { return x[0] + 0.0 * x[1] * x[1]; });
  program.Add(-1, 1, [](const X& x) { return x[1]; });
  const SolverResult result = Solve(&program, StartAt(Vector({0, 0})));
  EXPECT_EQ(result.status, SolverStatus::kUnbounded) << result.message;
  EXPECT_NE(result.message.find("'x1'"), std::string::npos) << result.message;
}

TEST(Solver, MoreEqualitiesThanVariablesAreRefused) {
  SmallProgram program(Boxes(1, -kUnbounded, kUnbounded), [](const X& x) { return x[0]; });
  program.Add(0, 0, [](const X& x) { return x[0]; }).Add(0, 0, [](const X& x) {
    return x[0] * x[0];
  });
  const SolverResult result = Solve(&program, StartAt(Vector({1})));
  EXPECT_EQ(result.status, SolverStatus::kFailed);
  EXPECT_NE(result.message.find("fewer free variables"), std::string::npos) << result.message;
}

TEST(Solver, AnInvalidNumberAtTheStartNamesTheConstraint) {
  SmallProgram program(Boxes(2, -kUnbounded, kUnbounded), [](const X& x) { return x[0] * x[0]; });
  program.Add(0, 0, [](const X& x) { return x[0]; }).Add(0, 0, [](const X& x) {
    return Log(x[1]) + x[0];
  });
  const SolverResult result = Solve(&program, StartAt(Vector({1, -1})));
  EXPECT_EQ(result.status, SolverStatus::kInvalidNumber);
  EXPECT_NE(result.message.find("constraint 'g2' is"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("starting point"), std::string::npos) << result.message;
}

TEST(Solver, AnInvalidNumberAtATrialPointShortensTheStep) {
  // log is undefined where full steps would go.
  SmallProgram program(Boxes(1, -kUnbounded, kUnbounded),
                       [](const X& x) { return x[0] - Log(x[0]); });
  int undefined = 0;
  class Counting : public SmallProgram {
   public:
    Counting(const SmallProgram& other, int* undefined)
        : SmallProgram(other), undefined_(undefined) {}
    double Objective(const VectorXd& x) override {
      if (!(x[0] > 0)) ++*undefined_;
      return SmallProgram::Objective(x);
    }

   private:
    int* undefined_;
  } counting(program, &undefined);
  const SolverResult result = Solve(&counting, StartAt(Vector({3})));
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
  EXPECT_NEAR(result.x[0], 1, 1e-7);
  EXPECT_GT(undefined, 0);
}

/// A program one of whose functions fails after some evaluations.
class Failing : public SmallProgram {
 public:
  enum class Where { kGradient, kJacobian, kHessian, kHessianThrows, kObjectiveThrowsLogic };

  Failing(const SmallProgram& other, Where where) : SmallProgram(other), where_(where) {}

  double Objective(const VectorXd& x) override {
    if (where_ == Where::kObjectiveThrowsLogic) throw std::logic_error("a bug");
    return SmallProgram::Objective(x);
  }
  void Gradient(const VectorXd& x, VectorXd* gradient) override {
    SmallProgram::Gradient(x, gradient);
    if (where_ == Where::kGradient && ++calls_ > 2) (*gradient)[1] = std::nan("");
  }
  void Jacobian(const VectorXd& x, VectorXd* values) override {
    SmallProgram::Jacobian(x, values);
    if (where_ == Where::kJacobian && ++calls_ > 2) (*values)[5] = kUnbounded;
  }
  void Hessian(const VectorXd& x, double factor, const VectorXd& multipliers,
               VectorXd* values) override {
    SmallProgram::Hessian(x, factor, multipliers, values);
    if (where_ == Where::kHessian && ++calls_ > 2) (*values)[4] = std::nan("");
    if (where_ == Where::kHessianThrows && ++calls_ > 2) throw std::runtime_error("no curvature");
  }

 private:
  Where where_;
  int calls_ = 0;
};

TEST(Solver, AnInvalidNumberInDerivativesIsNamed) {
  const std::vector<std::pair<Failing::Where, std::string>> cases = {
      {Failing::Where::kGradient, "objective with respect to 'x2' is nan"},
      {Failing::Where::kJacobian, "constraint 'g2' with respect to 'x2' is inf"},
      {Failing::Where::kHessian, "second derivative with respect to 'x3' and 'x2' is nan"},
      {Failing::Where::kHessianThrows, "no curvature"}};
  const Textbook hs071 = Textbooks()[4];
  for (const auto& [where, text] : cases) {
    for (const auto linear : {LinearSolver::kSparseLdlt, LinearSolver::kMumps}) {
      Failing program(hs071.program, where);
      SolverOptions options;
      options.linear_solver = linear;
      const SolverResult result = Solve(&program, StartAt(hs071.start), options);
      EXPECT_EQ(result.status, SolverStatus::kInvalidNumber) << result.message;
      EXPECT_NE(result.message.find(text), std::string::npos) << result.message;
      EXPECT_TRUE(result.x.allFinite());
    }
  }
}

TEST(Solver, OtherExceptionsOfTheProgramPassThrough) {
  const Textbook hs071 = Textbooks()[4];
  Failing program(hs071.program, Failing::Where::kObjectiveThrowsLogic);
  EXPECT_THROW(Solve(&program, StartAt(hs071.start)), std::logic_error);
  Textbook fine = Textbooks()[4];
  EXPECT_THROW(Solve(&fine.program, StartAt(fine.start), {}, {},
                     [](const SolverIteration&) { throw std::out_of_range("log"); }),
               std::out_of_range);
}

void ExpectInvalid(NonlinearProgram* program, const SolverGuess& guess,
                   const SolverOptions& options, const std::string& text) {
  try {
    Solve(program, guess, options);
    FAIL() << "accepted; expected: " << text;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(Solver, RefusesBadInputByName) {
  SmallProgram empty({}, [](const X&) { return Hyper(); });
  ExpectInvalid(&empty, StartAt(VectorXd()), {}, "no variables");

  const Textbook hs071 = Textbooks()[4];
  SmallProgram program = hs071.program;
  program.Add(3, 2, [](const X& x) { return x[0]; });
  ExpectInvalid(&program, StartAt(hs071.start), {}, "constraint 'g3'");
  program = hs071.program;
  program.mutable_lower()[2] = 7;
  ExpectInvalid(&program, StartAt(hs071.start), {},
                "variable 'x3': no value is at least 7 and at most 5");
  program.mutable_lower()[2] = std::nan("");
  ExpectInvalid(&program, StartAt(hs071.start), {}, "variable 'x3'");
  program = hs071.program;
  program.mutable_jacobian_pattern().Add(2, 0);
  ExpectInvalid(&program, StartAt(hs071.start), {}, "Jacobian has an entry (2, 0)");

  program = hs071.program;
  ExpectInvalid(&program, StartAt(Vector({1, 2})), {}, "2 variables instead of 4");
  ExpectInvalid(&program, StartAt(Vector({1, 2, 3, kUnbounded})), {}, "'x4' is inf");
  SolverGuess guess = StartAt(hs071.start);
  guess.lower_multipliers = VectorXd::Zero(4);
  ExpectInvalid(&program, guess, {}, "constraint multipliers");

  SolverOptions options;
  options.ipopt = {{"no_such_option", "1"}};
  ExpectInvalid(&program, StartAt(hs071.start), options, "no option 'no_such_option'");
  options.ipopt = {{"mu_strategy", "guesswork"}};
  ExpectInvalid(&program, StartAt(hs071.start), options, "'guesswork'");
  options.ipopt = {{"mu_init", "a lot"}};
  ExpectInvalid(&program, StartAt(hs071.start), options, "'a lot'");
  options.ipopt = {{"mu_init", "-1"}};
  ExpectInvalid(&program, StartAt(hs071.start), options, "'-1'");
  options.ipopt = {{"linear_solver", "ma57"}};
  ExpectInvalid(&program, StartAt(hs071.start), options, "SolverOptions::linear_solver");
}

TEST(Solver, TakesIpoptOptionsOfEveryType) {
  Textbook hs071 = Textbooks()[4];
  SolverOptions options;
  options.ipopt = {{"mu_strategy", "monotone"}, {"mu_init", "0.01"}, {"max_iter", "3"}};
  const SolverResult result = Solve(&hs071.program, StartAt(hs071.start), options);
  EXPECT_EQ(result.status, SolverStatus::kIterationLimit);
  EXPECT_EQ(result.history.size(), 4u);
  EXPECT_DOUBLE_EQ(result.history[0].barrier, 0.01);
}

TEST(Solver, LogsEveryIterationAndPrintsNothing) {
  Textbook hs071 = Textbooks()[4];
  std::vector<SolverIteration> logged;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const SolverResult result = Solve(&hs071.program, StartAt(hs071.start), {}, {},
                                    [&](const SolverIteration& it) { logged.push_back(it); });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(logged.size(), result.history.size());
  for (size_t k = 0; k < logged.size(); ++k) EXPECT_EQ(logged[k].number, static_cast<int>(k));
  EXPECT_NEAR(logged.back().objective, 17.0140173, 1e-4);
  EXPECT_GT(result.evaluations.objective, 0);
  EXPECT_GE(result.times.total, result.times.factorisation + result.times.derivatives);
}

TEST(Solver, WarmStartOfANeighbourTakesFewerIterations) {
  PendulumChain::Settings settings;
  settings.pendulums = 2;
  settings.knots = 30;
  settings.target = 0.5;
  settings.effort = 2;
  PendulumChain program(settings);
  const SolverResult first = Solve(&program, StartAt(program.Guess()));
  ASSERT_TRUE(first.succeeded()) << first.message;
  settings.effort = 2.02;
  PendulumChain neighbour(settings);
  const SolverResult cold = Solve(&neighbour, StartAt(neighbour.Guess()));
  const SolverResult warm = Solve(&neighbour, {first.x, first.constraint_multipliers,
                                               first.lower_multipliers, first.upper_multipliers});
  ASSERT_EQ(warm.status, SolverStatus::kSolved) << warm.message;
  EXPECT_LT(2 * warm.history.size(), cold.history.size());
  EXPECT_NEAR(warm.objective, cold.objective, 1e-6 * cold.objective);
}

}  // namespace
}  // namespace possibility::collocation
