#include "collocation/study/optimal_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

/// x' = -x + u with the least integral of x^2 + u^2. The solution is smooth but not polynomial, so
/// every scheme has an error.
std::unique_ptr<OptimalControlProblem> Smooth() {
  auto problem = std::make_unique<OptimalControlProblem>("smooth");
  Phase& phase = problem->AddPhase("only");
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u");
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<2, 1>([](const auto& z, auto* f) { (*f)[0] = z[1] - z[0]; }),
                    {x, u});
  phase.Fix(x, 1.5, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.AddIntegralCost("squares", Differentiated<2, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * z[0] + z[1] * z[1];
                        }),
                        {x, u}, 0.5);
  return problem;
}

/// Closed form: x = a e^(w t) + b e^(-w t), w = sqrt 2.
double SmoothOptimum() {
  const double w = std::sqrt(2.0);
  const double e = std::exp(w);
  const double a = (1 - 1.5 / e) / (e - 1 / e);
  const double b = 1.5 - a;
  // u = x' + x; the integral of x^2 + u^2 over [0, 1].
  const double p = 1 + (w + 1) * (w + 1);
  const double m = 1 + (1 - w) * (1 - w);
  const double mixed = 1 + (w + 1) * (1 - w);
  return 0.5 * (a * a * p * (e * e - 1) / (2 * w) + b * b * m * (1 - 1 / (e * e)) / (2 * w) +
                2 * a * b * mixed);
}

double ErrorWith(const TranscriptionScheme& scheme, int intervals) {
  const auto problem = Smooth();
  OptimalControlOptions options;
  options.scheme = scheme;
  options.intervals = {intervals};
  options.solver.tolerance = 1e-12;
  const OptimalControlResult result = SolveOptimalControl(*problem, options);
  EXPECT_TRUE(result.succeeded()) << result.message;
  return std::abs(result.objective - SmoothOptimum());
}

TEST(OptimalControlTest, SchemesHaveTheirOrdersOfConvergence) {
  for (const auto& [scheme, order] : {std::pair{Trapezoidal(), 2.0},
                                      {HermiteSimpson(), 4.0},
                                      {CompressedHermiteSimpson(), 4.0}}) {
    const double coarse = ErrorWith(scheme, 4);
    const double fine = ErrorWith(scheme, 8);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2)
        << scheme.name << ": " << coarse << ", " << fine;
  }
}

/// A pendulum swung to the side with least effort, as a second-order or a first-order system.
std::unique_ptr<OptimalControlProblem> Pendulum(int order) {
  auto problem = std::make_unique<OptimalControlProblem>("pendulum");
  Phase& phase = problem->AddPhase("swing", order);
  const Variable q = phase.AddCoordinate("q");
  const Variable v = order == 2 ? phase.Rate(q) : phase.AddCoordinate("v");
  const Variable u = phase.AddControl("torque");
  phase.SetDuration(2);
  if (order == 2) {
    phase.SetDynamics(
        Differentiated<2, 1>([](const auto& z, auto* a) { (*a)[0] = z[1] - 9.81 * sin(z[0]); }),
        {q, u});
  } else {
    phase.SetDynamics(Differentiated<3, 2>([](const auto& z, auto* f) {
                        (*f)[0] = z[1];
                        (*f)[1] = z[2] - 9.81 * sin(z[0]);
                      }),
                      {q, v, u});
  }
  phase.Fix(q, 0, At::kStart);
  phase.Fix(v, 0, At::kStart);
  phase.Fix(q, 2, At::kEnd);
  phase.Fix(v, 0, At::kEnd);
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

/// Greatest |q'' - f(q, u)| between the knots, with q'' the second derivative of the returned q.
double DynamicsError(int order, int intervals) {
  const auto problem = Pendulum(order);
  OptimalControlOptions options;
  options.intervals = {intervals};
  const OptimalControlResult result = SolveOptimalControl(*problem, options);
  EXPECT_TRUE(result.succeeded()) << result.message;
  const PhaseTrajectory& motion = result.trajectory.phases[0];
  double greatest = 0;
  for (int i = 0; i < 40 * intervals; ++i) {
    const double s = (i + 0.5) / (40 * intervals);
    const double step = 1e-5;
    // The second derivative comes from q alone and never spans a knot.
    const double q = motion.Coordinates(s)[0];
    const double h = step * motion.duration;
    const double acceleration =
        (motion.Coordinates(s + step)[0] - 2 * q + motion.Coordinates(s - step)[0]) / (h * h);
    greatest =
        std::max(greatest, std::abs(acceleration - (motion.Controls(s)[0] - 9.81 * std::sin(q))));
  }
  return greatest;
}

TEST(OptimalControlTest, TheSecondOrderFormObeysTheDynamicsBetterOnTheSameMesh) {
  for (const int intervals : {10, 20}) {
    EXPECT_LT(DynamicsError(2, intervals), DynamicsError(1, intervals) / 5) << intervals;
  }
}

TEST(OptimalControlTest, RefinesTheMeshUntilTheErrorIsSmallEnough) {
  const auto problem = Pendulum(2);
  OptimalControlOptions options;
  options.intervals = {4};
  options.mesh_tolerance = 1e-5;
  const OptimalControlResult result = SolveOptimalControl(*problem, options);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_GT(result.refinements, 0);
  EXPECT_LE(result.mesh_error, 1e-5);
  options.intervals = {200};
  options.mesh_tolerance = 0;
  EXPECT_NEAR(result.objective, SolveOptimalControl(*problem, options).objective, 1e-4);
}

TEST(OptimalControlTest, StartFromASolutionTakesFewerIterations) {
  const auto problem = Pendulum(2);
  const OptimalControlResult cold = SolveOptimalControl(*problem);
  ASSERT_TRUE(cold.succeeded());
  const OptimalControlResult warm = SolveOptimalControl(*problem, {}, cold.trajectory);
  ASSERT_TRUE(warm.succeeded());
  EXPECT_LT(warm.iterations, cold.iterations);
  EXPECT_NEAR(warm.objective, cold.objective, 1e-6 * cold.objective);
}

TEST(OptimalControlTest, CancelledWhileTheProgramIsBuiltGivesNoTrajectory) {
  const auto problem = Smooth();
  const CancellationToken cancelled([] { return false; });
  const OptimalControlResult result = SolveOptimalControl(*problem, {}, std::nullopt, cancelled);
  EXPECT_EQ(result.status, SolverStatus::kCancelled);
  EXPECT_EQ(result.message, "cancelled");
  EXPECT_TRUE(result.trajectory.phases.empty());
  EXPECT_TRUE(std::isnan(result.mesh_error));
  EXPECT_TRUE(result.violations.empty());
}

TEST(OptimalControlTest, CancelledAfterAnIterationGivesItsTrajectory) {
  const auto problem = Smooth();
  bool cancelled = false;
  const OptimalControlResult result =
      SolveOptimalControl(*problem, {}, std::nullopt, CancellationToken([&] { return !cancelled; }),
                          [&](const SolverIteration&) { cancelled = true; });
  EXPECT_EQ(result.status, SolverStatus::kCancelled);
  EXPECT_EQ(result.trajectory.phases.size(), 1U);
  EXPECT_TRUE(std::isnan(result.mesh_error));
}

TEST(OptimalControlTest, NamesTheConstraintThatCannotBeMet) {
  // The force is far too small to move the mass by 2 m in half a second.
  auto weak = std::make_unique<OptimalControlProblem>("weak");
  Phase& phase = weak->AddPhase("lift", 2);
  const Variable q = phase.AddCoordinate("q");
  const Variable u = phase.AddControl("torque", {-0.1, 0.1});
  phase.SetDuration(0.5);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Fix(q, 0, At::kStart);
  phase.Fix(phase.Rate(q), 0, At::kStart);
  phase.Fix(q, 2, At::kEnd);
  const OptimalControlResult result = SolveOptimalControl(*weak);
  EXPECT_EQ(result.status, SolverStatus::kInfeasible) << result.message;
  double worst = 0;
  for (const auto& [name, violation] : result.violations) {
    worst = std::max(worst, violation.amount);
    EXPECT_EQ(violation.where.rfind("lift, ", 0), 0U) << violation.where;
  }
  EXPECT_GT(worst, 0.01);
}

TEST(TrajectoryValue, IsTheVariableAtItsTime) {
  // Two phases of free duration; x runs on at 2 m/s.
  OptimalControlProblem problem("two phases");
  Phase& first = problem.AddPhase("first");
  Phase& second = problem.AddPhase("second");
  std::vector<Variable> x;
  for (Phase* phase : {&first, &second}) {
    x.push_back(phase->AddCoordinate("x"));
    phase->SetDynamics(FunctionOf([](auto at) { return 2.0 + 0.0 * at; }), {x.back()});
    phase->SetDuration({0.5, 0.5});
  }
  problem.Continue({x[0], At::kEnd}, {x[1], At::kStart});
  first.Fix(x[0], 1, At::kStart);
  const Variable height = problem.AddParameter("height", {3, 3});
  problem.AddCost({height, At::kStart});
  const OptimalControlResult result = SolveOptimalControl(problem);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.Value(x[0], 0.25), 1.5, 1e-9);
  EXPECT_NEAR(result.Value(x[1], 0.75), 2.5, 1e-9);
  EXPECT_NEAR(result.Value(second.Rate(x[1]), 1.0), 2, 1e-9);
  EXPECT_EQ(result.Value(second.duration(), 0), 0.5);
  EXPECT_EQ(result.Value(second.time(), 0.8), 0.8);
  EXPECT_NEAR(result.Value(height, 0), 3, 1e-9);
  EXPECT_THROW(result.Value(x[0], 0.75), std::invalid_argument);
  EXPECT_THROW(result.Value(x[1], 0.25), std::invalid_argument);
  EXPECT_THROW(result.Value(x[1], std::nan("")), std::invalid_argument);
  EXPECT_THROW(result.Value({VariableKind::kCoordinate, 2, 0, 0}, 0.25), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::collocation
