#include "collocation/transcription/transcription.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>

#include "collocation/problem/function_algebra.h"
#include "tests/dynamics/richardson.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

using dynamics::RelativeError;
using dynamics::RichardsonJacobian;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A problem with every feature: two phases of different order, free and fixed durations, time, a
/// parameter, bounds inside, links, costs of every kind.
/// `with_rates`: with what needs controls that do not jump at knots.
std::unique_ptr<OptimalControlProblem> Medley(bool with_rates = true) {
  auto problem = std::make_unique<OptimalControlProblem>("medley");
  const Variable gain = problem->AddParameter("gain", {0, 5}, 2, 1);
  Phase& run = problem->AddPhase("run", 1);
  const Variable x = run.AddCoordinate("x", {-3, 3}, 2);
  const Variable y = run.AddCoordinate("y", {}, 0.5);
  const Variable u = run.AddControl("u", {-1, 1}, 3);
  run.SetDuration({0.5, 2});
  run.SetDynamics(Differentiated<5, 2>([](const auto& z, auto* f) {
                    (*f)[0] = z[1] * z[1] + z[2] * z[3];
                    (*f)[1] = sin(z[0]) * z[2] - z[1] * z[4];
                  }),
                  {x, y, u, gain, run.time()});
  run.Constrain("tube", Differentiated<3, 1>([](const auto& z, auto* f) {
                  (*f)[0] = z[0] * z[0] + exp(z[1]) * z[2];
                }),
                {x, y, run.duration()}, {{-1, 4}}, At::kAfterStart);
  run.AddIntegralCost(
      "effort", Differentiated<2, 1>([](const auto& z, auto* f) { (*f)[0] = z[0] * z[0] * z[1]; }),
      {u, y}, 0.3);
  run.ConstrainIntegral("work", Differentiated<3, 1>([](const auto& z, auto* f) {
                          (*f)[0] = z[0] * z[1] + sin(z[2]);
                        }),
                        {u, x, run.time()}, {-1, 2}, 3);
  if (with_rates) {
    run.AddRateCost(u, 0.2);
    run.BoundRate(u, {-4, 5});
  }
  Phase& fly = problem->AddPhase("fly", 2);
  const Variable q = fly.AddCoordinate("q", {-4, 4});
  const Variable r = fly.AddCoordinate("r");
  const Variable lag = fly.AddCoordinateOfOrder(1, "lag", {}, 0.7);
  fly.SetScale(fly.Rate(q), 5);
  const Variable f = fly.AddControl("f");
  fly.SetDuration({0.2, 1});
  fly.SetDynamics(Differentiated<5, 3>([](const auto& z, auto* a) {
                    (*a)[0] = z[2] * cos(z[0]) - z[1] * z[3];
                    (*a)[1] = z[1] / (1 + z[2] * z[2]);
                    (*a)[2] = z[2] * z[0] - z[4] * z[4];
                  }),
                  {q, fly.Rate(q), f, fly.time(), lag});
  fly.AddIntegralCost("shake", Differentiated<2, 1>([](const auto& z, auto* c) {
                        (*c)[0] = z[0] * z[0] + z[1] * z[1];
                      }),
                      {fly.Rate(q, 2), fly.Rate(r)});
  if (with_rates) {
    fly.AddRateCost(f, 0.4);
    problem->Continue({u, At::kEnd}, {f, At::kStart});
  } else {
    fly.Bound(f, {-2, 0.4}, At::kStart);  // a row where it is no variable
    fly.Bound(fly.Rate(q, 2), {-9, 9}, At::kEnd);
  }
  problem->Continue({x, At::kEnd}, {q, At::kStart});
  // At instants between the knots, of every kind of quantity.
  problem->Link("through", Differentiated<5, 1>([](const auto& z, auto* g) {
                  (*g)[0] = z[0] * z[1] + z[2] * z[2] * z[3] - z[4];
                }),
                {AtShare(q, 0.37), AtShare(fly.Rate(q), 0.71), AtShare(fly.Rate(r, 2), 0.9),
                 AtShare(fly.Rate(lag), 0.15), AtShare(fly.time(), 0.6)},
                {{-1, 3}});
  problem->AddCost("data", Differentiated<2, 1>([](const auto& z, auto* c) {
                     (*c)[0] = (z[0] - 0.4) * (z[0] - 0.4) * z[1];
                   }),
                   {AtShare(r, 0.5), AtShare(x, 1)}, 0.2);
  problem->Link("jump", Differentiated<3, 2>([](const auto& z, auto* g) {
                  (*g)[0] = z[0] * z[1] - z[2];
                  (*g)[1] = z[2] * z[2];
                }),
                {{y, At::kEnd}, {run.duration(), At::kStart}, {fly.Rate(r), At::kStart}},
                {{0, 0}, {-1, 1}});
  problem->AddCost(
      "miss", Differentiated<2, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0] * z[1]; }),
      {{q, At::kEnd}, {gain, At::kStart}}, 2);
  problem->AddCost({fly.duration(), At::kEnd}, 0.1);
  return problem;
}

MatrixXd Dense(const SparsityPattern& pattern, const VectorXd& values, int rows, int columns) {
  MatrixXd dense = MatrixXd::Zero(rows, columns);
  for (int i = 0; i < pattern.size(); ++i) {
    dense(pattern.rows[i], pattern.columns[i]) += values[i];
  }
  return dense;
}

VectorXd RandomPoint(std::mt19937* random, const Transcription& program) {
  std::uniform_real_distribution<double> uniform(0.2, 0.9);
  VectorXd x(program.num_variables());
  for (double& element : x) element = uniform(*random);
  return x;
}

class EveryScheme : public ::testing::TestWithParam<TranscriptionScheme> {};

TEST_P(EveryScheme, DerivativesAgreeWithDifferences) {
  const auto problem = Medley(GetParam().IsClosed());
  Transcription program(*problem, GetParam(), {{0, 0.3, 1}, {0, 0.5, 0.6, 1}});
  std::mt19937 random(1);
  const int n = program.num_variables();
  const double step = 0.01;  // durations are as short as 0.2, and rates have their inverses
  for (int trial = 0; trial < 5; ++trial) {
    const VectorXd x = RandomPoint(&random, program);
    const VectorXd multipliers = VectorXd::Random(program.num_constraints());
    VectorXd gradient, jacobian_values, hessian_values;
    program.Gradient(x, &gradient);
    program.Jacobian(x, &jacobian_values);
    program.Hessian(x, 0.7, multipliers, &hessian_values);
    const MatrixXd J =
        Dense(program.jacobian_pattern(), jacobian_values, program.num_constraints(), n);
    MatrixXd H = Dense(program.hessian_pattern(), hessian_values, n, n);
    EXPECT_TRUE(H.isLowerTriangular(0));
    H.triangularView<Eigen::StrictlyUpper>() = H.transpose();

    const MatrixXd objective_differences = RichardsonJacobian(
        [&](const VectorXd& d) { return VectorXd::Constant(1, program.Objective(x + d)); }, n,
        step);
    EXPECT_LT(RelativeError(gradient.transpose(), objective_differences), 1e-8);
    const MatrixXd constraint_differences = RichardsonJacobian(
        [&](const VectorXd& d) {
          VectorXd g;
          program.Constraints(x + d, &g);
          return g;
        },
        n, step);
    EXPECT_LT(RelativeError(J, constraint_differences), 1e-8);
    const MatrixXd gradient_differences = RichardsonJacobian(
        [&](const VectorXd& d) {
          VectorXd g, values;
          program.Gradient(x + d, &g);
          program.Jacobian(x + d, &values);
          const MatrixXd at =
              Dense(program.jacobian_pattern(), values, program.num_constraints(), n);
          return VectorXd(0.7 * g + at.transpose() * multipliers);
        },
        n, step);
    EXPECT_LT(RelativeError(H, gradient_differences), 1e-8);
  }
}

TEST_P(EveryScheme, SeveralThreadsGiveTheSameValuesButForRounding) {
  const auto problem = Medley(GetParam().IsClosed());
  const std::vector<Mesh> meshes = {{0, 0.3, 1}, {0, 0.5, 0.6, 1}};
  Transcription alone(*problem, GetParam(), meshes);
  std::mt19937 random(3);
  for (const int threads : {2, 5}) {
    Transcription shared(*problem, GetParam(), meshes, {}, threads);
    EXPECT_EQ(shared.hessian_pattern().rows, alone.hessian_pattern().rows);
    EXPECT_EQ(shared.hessian_pattern().columns, alone.hessian_pattern().columns);
    for (int trial = 0; trial < 20; ++trial) {
      const VectorXd x = RandomPoint(&random, alone);
      const VectorXd multipliers = VectorXd::Random(alone.num_constraints());
      VectorXd expected, values;
      alone.Constraints(x, &expected);
      shared.Constraints(x, &values);
      EXPECT_EQ(values, expected);
      alone.Jacobian(x, &expected);
      shared.Jacobian(x, &values);
      EXPECT_EQ(values, expected);
      alone.Hessian(x, 0.7, multipliers, &expected);
      shared.Hessian(x, 0.7, multipliers, &values);
      EXPECT_LE((values - expected).lpNorm<Eigen::Infinity>(),
                1e-14 * expected.lpNorm<Eigen::Infinity>());
    }
  }
}

/// y = z^2, slowly. Notes if two threads evaluate it at once.
class JealousSquare : public Function {
 public:
  explicit JealousSquare(bool fails = false) : Function(1, 1), fails_(fails) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    Guarded([&] { (*y)[0] = z[0] * z[0]; });
  }
  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    Guarded([&] { (*J)(0, 0) = 2 * z[0]; });
  }
  void Hessian(const VectorXd&, const VectorXd& multipliers, MatrixXd* H) override {
    Guarded([&] { (*H)(0, 0) = fails_ ? std::nan("") : 2 * multipliers[0]; });
  }
  bool was_shared() const { return was_shared_; }

 private:
  template <typename Run>
  void Guarded(const Run& run) {
    if (busy_.exchange(true)) was_shared_ = true;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    run();
    busy_ = false;
  }

  bool fails_;
  std::atomic<bool> busy_ = false, was_shared_ = false;
};

/// Two phases that must be above 1 by the same function, one of them by way of another function.
std::unique_ptr<OptimalControlProblem> WithShared(const std::shared_ptr<Function>& f) {
  auto problem = std::make_unique<OptimalControlProblem>("sharing");
  for (const char* name : {"first", "second"}) {
    Phase& phase = problem->AddPhase(name, 1);
    const Variable x = phase.AddCoordinate("x");
    phase.SetDuration(1);
    phase.SetDynamics(FunctionOf([](auto z) { return -z; }), {x});
    const bool direct = phase.name() == "first";
    const std::shared_ptr<Function> g =
        direct ? f : Composition(LinearMap(MatrixXd::Constant(1, 1, 3)), f);
    phase.Constrain("jealous", g, {x}, {{1, kInfinity}});
  }
  return problem;
}

TEST(Transcription, AFunctionIsNotEvaluatedByTwoThreadsAtOnce) {
  const auto f = std::make_shared<JealousSquare>();
  const auto problem = WithShared(f);
  Transcription program(*problem, HermiteSimpson(), {UniformMesh(3), UniformMesh(3)}, {}, 3);
  const VectorXd x = VectorXd::Ones(program.num_variables());
  for (int trial = 0; trial < 10; ++trial) {
    VectorXd values;
    program.Constraints(x, &values);
    program.Jacobian(x, &values);
    program.Hessian(x, 1, VectorXd::Ones(program.num_constraints()), &values);
  }
  EXPECT_FALSE(f->was_shared());
}

TEST(Transcription, ThreadsNameTheFunctionThatFails) {
  const auto problem = WithShared(std::make_shared<JealousSquare>(true));
  Transcription program(*problem, HermiteSimpson(), {UniformMesh(1), UniformMesh(1)}, {}, 2);
  VectorXd values;
  const std::string message = MessageOf<std::runtime_error>([&] {
    program.Hessian(VectorXd::Ones(program.num_variables()), 1,
                    VectorXd::Ones(program.num_constraints()), &values);
  });
  EXPECT_NE(message.find("constraint 'first, knot 0"), std::string::npos) << message;
  EXPECT_NE(message.find("jealous"), std::string::npos) << message;
  EXPECT_NE(message.find("second derivative"), std::string::npos) << message;
}

TEST_P(EveryScheme, APolynomialMotionIsTranscribedExactly) {
  // q is of degree 2 + the highest derivative's degree. The transcription is exact for it.
  OptimalControlProblem problem("polynomial");
  Phase& phase = problem.AddPhase("only", 2);
  const Variable q = phase.AddCoordinate("q");
  phase.SetDuration(2);
  phase.AddIntegralCost("shake",
                        Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }),
                        {phase.Rate(q, 2)});
  phase.Guess(q, [](double s) { return 1 - 2 * s + 6 * s * s - 4 * s * s * s; });
  phase.Guess(phase.Rate(q), [](double s) { return (-2 + 12 * s - 12 * s * s) / 2; });
  phase.Guess(phase.Rate(q, 2), [](double s) { return (12 - 24 * s) / 4; });
  Transcription program(problem, GetParam(), {{0, 0.1, 0.7, 1}});
  const VectorXd x = program.InitialGuess();
  VectorXd defects;
  program.Constraints(x, &defects);
  EXPECT_LT(defects.cwiseAbs().maxCoeff(), 1e-14);
  // The trajectory gives the motion back everywhere, with all its derivatives.
  const Trajectory trajectory = program.TrajectoryOf(x);
  for (double s = 0; s <= 1; s += 0.05) {
    const PhaseTrajectory& motion = trajectory.phases[0];
    EXPECT_NEAR(motion.Coordinates(s)[0], 1 - 2 * s + 6 * s * s - 4 * s * s * s, 1e-13);
    EXPECT_NEAR(motion.Coordinates(s, 1)[0], (-2 + 12 * s - 12 * s * s) / 2, 1e-13);
    EXPECT_NEAR(motion.Coordinates(s, 2)[0], (12 - 24 * s) / 4, 1e-13);
  }
  // A guess on another mesh starts from it without loss.
  Transcription finer(problem, GetParam(), {UniformMesh(7)});
  finer.Constraints(finer.GuessFrom(trajectory), &defects);
  EXPECT_LT(defects.cwiseAbs().maxCoeff(), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(TranscriptionTest, EveryScheme,
                         ::testing::Values(Trapezoidal(), HermiteSimpson(),
                                           CompressedHermiteSimpson(), GaussLobatto(4),
                                           LegendreGauss(2), FlippedRadau(3)),
                         [](const auto& info) { return info.param.name; });

TEST(TranscriptionTest, SchemesHaveThePublishedCoefficients) {
  const TranscriptionScheme simpson = HermiteSimpson();
  // Moreno-Martin, Ros & Celaya 2023, of the accelerations a0, ac, a1 over an interval of length 1.
  EXPECT_LT((simpson.integral[1].row(2) - Eigen::RowVector3d(1, 4, 1) / 6).norm(), 1e-14);
  EXPECT_LT((simpson.integral[1].row(1) - Eigen::RowVector3d(5, 8, -1) / 24).norm(), 1e-14);
  EXPECT_LT((simpson.integral[2].row(2) - Eigen::RowVector3d(1, 2, 0) / 6).norm(), 1e-14);
  EXPECT_LT((simpson.integral[2].row(1) - Eigen::RowVector3d(7, 6, -1) / 96).norm(), 1e-14);
  const TranscriptionScheme trapezoidal = Trapezoidal();
  EXPECT_LT((trapezoidal.integral[1].row(1) - Eigen::RowVector2d(1, 1) / 2).norm(), 1e-14);
  EXPECT_LT((trapezoidal.integral[2].row(1) - Eigen::RowVector2d(2, 1) / 6).norm(), 1e-14);
  EXPECT_THROW(SchemeOfNodes("bad", {0, 0.5}, true), std::invalid_argument);
  // Abramowitz & Stegun 1964, table 25.6, moved from [-1, 1] to [0, 1].
  EXPECT_EQ(GaussLobatto(2).nodes, Trapezoidal().nodes);
  EXPECT_NEAR(GaussLobatto(3).nodes[1], 0.5, 1e-15);
  const TranscriptionScheme six = GaussLobatto(6);
  EXPECT_NEAR(six.nodes[1], (1 - 0.765055323929465) / 2, 1e-13);
  EXPECT_NEAR(six.nodes[2], (1 - 0.285231516480645) / 2, 1e-13);
  EXPECT_NEAR(six.weights()[0], 0.066666666666667 / 2, 1e-13);
  EXPECT_NEAR(six.weights()[1], 0.378474956297847 / 2, 1e-13);
  EXPECT_THROW(GaussLobatto(1), std::invalid_argument);
}

void ExpectNodes(const TranscriptionScheme& scheme, const std::vector<double>& nodes,
                 const std::vector<double>& weights) {
  ASSERT_EQ(scheme.nodes.size(), nodes.size()) << scheme.name;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_NEAR(scheme.nodes[i], nodes[i], 1e-14) << scheme.name << ", node " << i;
    EXPECT_NEAR(scheme.weights()[i], weights[i], 1e-14) << scheme.name << ", node " << i;
  }
}

TEST(TranscriptionTest, NodesOfGaussAndRadauHaveTheirPublishedValues) {
  // Abramowitz & Stegun 1964, table 25.4, moved from [-1, 1] to [0, 1].
  const double two = 0.577350269189626;
  ExpectNodes(LegendreGauss(2), {0, (1 - two) / 2, (1 + two) / 2, 1}, {0, 0.5, 0.5, 0});
  const double four = 0.861136311594053, inner = 0.339981043584856;
  const double outer_weight = 0.347854845137454 / 2, inner_weight = 0.652145154862546 / 2;
  ExpectNodes(LegendreGauss(4),
              {0, (1 - four) / 2, (1 - inner) / 2, (1 + inner) / 2, (1 + four) / 2, 1},
              {0, outer_weight, inner_weight, inner_weight, outer_weight, 0});
  // Hairer & Wanner 1996, table IV.5.5: Radau IIA.
  ExpectNodes(FlippedRadau(2), {0, 1.0 / 3, 1}, {0, 0.75, 0.25});
  const double root = std::sqrt(6.0);
  ExpectNodes(FlippedRadau(3), {0, (4 - root) / 10, (4 + root) / 10, 1},
              {0, (16 - root) / 36, (16 + root) / 36, 1.0 / 9});
  EXPECT_NEAR(FlippedRadau(3).integral[1](1, 2), (296 - 169 * root) / 1800, 1e-14);
  EXPECT_THROW(LegendreGauss(0), std::invalid_argument);
  EXPECT_THROW(FlippedRadau(0), std::invalid_argument);
  EXPECT_THROW(SchemeOfNodes("none", {0, 1}, true, false, false), std::invalid_argument);
}

TEST(TranscriptionTest, CompressedHasNoStatesInside) {
  const auto problem = Medley();
  const std::vector<Mesh> meshes = {UniformMesh(4), UniformMesh(3)};
  const Transcription separated(*problem, HermiteSimpson(), meshes);
  const Transcription compressed(*problem, CompressedHermiteSimpson(), meshes);
  // 2 states in 4 interval middles and 5 in 3. Where they are bounded, a row takes their place.
  EXPECT_EQ(separated.num_variables() - compressed.num_variables(), 2 * 4 + 5 * 3);
  EXPECT_EQ(separated.num_constraints() - compressed.num_constraints(), 1 * 4 + 4 * 3);
}

TEST(TranscriptionTest, NamesHoldPhaseKnotAndQuantity) {
  const auto problem = Medley();
  const Transcription program(*problem, HermiteSimpson(), {UniformMesh(2), UniformMesh(1)});
  EXPECT_EQ(program.VariableName(0), "gain");
  EXPECT_EQ(program.VariableName(1), "run: duration");
  EXPECT_EQ(program.VariableName(2), "run, knot 0 (t = 0 of the duration): x");
  EXPECT_EQ(program.ConstraintName(0),
            "run, interval 0, node 1 (t = 0.25 of the duration): defect of x");
  EXPECT_EQ(program.ConstraintName(program.num_constraints() - 1), "jump[1]");
}

TEST(TranscriptionTest, ContradictoryProblemsAreRefusedByName) {
  const auto transcribe = [](const OptimalControlProblem& problem) {
    Transcription(problem, HermiteSimpson(), {UniformMesh(2)});
  };
  OptimalControlProblem problem("task");
  EXPECT_EQ(MessageOf([&] { transcribe(problem); }), "task: the problem has no phase");
  Phase& phase = problem.AddPhase("go");
  EXPECT_EQ(MessageOf([&] { transcribe(problem); }),
            "task: phase 'go': the phase has no coordinates");
  const Variable x = phase.AddCoordinate("x", {0, 1});
  EXPECT_EQ(MessageOf([&] { transcribe(problem); }), "task: phase 'go': no duration was set");
  EXPECT_EQ(MessageOf([&] { phase.SetDuration(0); }),
            "task: phase 'go': expected a duration within finite bounds above 0, got [0, 0]");
  phase.SetDuration(1);
  EXPECT_EQ(MessageOf([&] {
              phase.Bound(x, {2, 1});
            }),
            "task: phase 'go': 'x': contradictory bounds [2, 1]");
  EXPECT_EQ(MessageOf([&] { phase.Rate(x, 2); }),
            "task: phase 'go': 'x' has no derivative of order 2");
  EXPECT_EQ(MessageOf([&] {
              phase.Constrain("c", Differentiated<2, 1>([](const auto&, auto*) {}), {x}, {{0, 0}});
            }),
            "task: phase 'go': 'c' takes 2 arguments, got 1");
  phase.Fix(x, 3, At::kEnd);
  EXPECT_EQ(MessageOf([&] { transcribe(problem); }),
            "task: go, knot 2 (t = 1 of the duration): x: contradictory bounds [3, 1]");
  EXPECT_EQ(MessageOf([&] {
              Transcription(problem, HermiteSimpson(), {{0, 0.5, 0.5, 1}});
            }),
            "task: phase 'go': the mesh must ascend from 0 to 1");
  EXPECT_EQ(MessageOf([&] { UniformMesh(0); }), "a mesh has 0 intervals, expected 1 or more");
  EXPECT_EQ(MessageOf([&] { problem.AddPhase("go"); }), "task: two phases are named 'go'");
}

}  // namespace
}  // namespace possibility::collocation
