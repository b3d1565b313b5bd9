#include "collocation/study/optimal_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/collocation/study/neighbouring_problems.h"

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
                                      {CompressedHermiteSimpson(), 4.0},
                                      {GaussLobatto(4), 6.0},
                                      {LegendreGauss(1), 2.0},
                                      {LegendreGauss(2), 4.0},
                                      {LegendreGauss(3), 6.0},
                                      {FlippedRadau(1), 1.0},
                                      {FlippedRadau(2), 3.0},
                                      {FlippedRadau(3), 5.0}}) {
    EXPECT_EQ(scheme.order(), order) << scheme.name;
    const double coarse = ErrorWith(scheme, 4);
    const double fine = ErrorWith(scheme, 8);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2)
        << scheme.name << ": " << coarse << ", " << fine;
  }
}

std::shared_ptr<Function> Squared() {
  return FunctionOf([](auto u) { return u * u; });
}

/// Dido's problem for small slopes: the string of least energy above an area of 1 is a parabola,
/// 6 t (1 - t), and the energy is 12.
TEST(IntegralConstraint, TheStringOfLeastEnergyAboveAnAreaIsAParabola) {
  OptimalControlProblem problem("string");
  Phase& phase = problem.AddPhase("only");
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 0, At::kEnd);
  phase.AddIntegralCost("energy", Squared(), {phase.Rate(x)});
  phase.ConstrainIntegral("area", FunctionOf([](auto height) { return height; }), {x}, {1, 1});
  const OptimalControlResult result = SolveOptimalControl(problem);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, 12, 1e-6);
  for (const double t : {0.1, 0.35, 0.5, 0.8}) {
    EXPECT_NEAR(result.Value(x, t), 6 * t * (1 - t), 1e-6) << t;
  }
}

/// With its duration free, time costs as much as the energy saves: 12 / T^3 + T is least at T^4
/// = 36.
TEST(IntegralConstraint, HoldsInAPhaseOfFreeDuration) {
  OptimalControlProblem problem("string");
  Phase& phase = problem.AddPhase("only");
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration({0.5, 5});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 0, At::kEnd);
  phase.AddIntegralCost("energy", Squared(), {phase.Rate(x)});
  phase.ConstrainIntegral("area", FunctionOf([](auto height) { return height; }), {x},
                          {1, kInfinity});
  problem.AddCost({phase.duration(), At::kEnd});
  const OptimalControlResult result = SolveOptimalControl(problem);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.trajectory.phases[0].duration, std::sqrt(6.0), 1e-5);
}

/// The energy of a clamped beam deflected by 1 in the middle is 192 EI / L^3 (twice the work).
/// From one knot to the next its shape is a cubic, so it is exact where the middle is a knot.
double BeamEnergy(int intervals) {
  OptimalControlProblem problem("beam");
  Phase& phase = problem.AddPhase("only", 2);
  const Variable w = phase.AddCoordinate("w");
  phase.SetDuration(1);
  for (const At end : {At::kStart, At::kEnd}) {
    phase.Fix(w, 0, end);
    phase.Fix(phase.Rate(w), 0, end);
  }
  phase.AddIntegralCost("energy", Squared(), {phase.Rate(w, 2)});
  problem.Link("deflection", FunctionOf([](auto deflection) { return deflection; }),
               {AtShare(w, 0.5)}, {{1, 1}});
  OptimalControlOptions options;
  options.intervals = {intervals};
  const OptimalControlResult result = SolveOptimalControl(problem, options);
  EXPECT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.Value(w, 0.5), 1, 1e-9);
  return result.objective;
}

TEST(Instants, ABeamIsDeflectedWhereNoKnotNeedBe) {
  EXPECT_NEAR(BeamEnergy(4), 192, 1e-5);
  // The middle of an interval: a smooth polynomial instead of the kink in the shear force.
  EXPECT_GT(BeamEnergy(5), 192);
  EXPECT_NEAR(BeamEnergy(41), 192, 0.5);
}

/// Decay with rate and start unknown, fitted to data between the knots.
TEST(Instants, ParametersAreFittedToData) {
  OptimalControlProblem problem("decay");
  Phase& phase = problem.AddPhase("only");
  const Variable x = phase.AddCoordinate("x");
  const Variable rate = problem.AddParameter("rate", {0, 5}, 1, 2);
  phase.SetDuration(3);
  phase.SetDynamics(FunctionOf([](auto y, auto k) { return -k * y; }), {x, rate});
  phase.Guess(x, 1);
  for (const double t : {0.2, 0.7, 1.1, 1.9, 2.9}) {
    const double datum = 4 * std::exp(-0.7 * t);
    problem.AddCost("miss", FunctionOf([datum](auto y) { return (y - datum) * (y - datum); }),
                    {AtShare(x, t / 3)});
  }
  OptimalControlOptions options;
  options.scheme = GaussLobatto(4);
  options.intervals = {10};
  options.solver.tolerance = 1e-12;
  const OptimalControlResult result = SolveOptimalControl(problem, options);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.trajectory.parameters[0], 0.7, 1e-6);
  EXPECT_NEAR(result.Value(x, 0), 4, 1e-6);
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

/// The numbers of iterations of the solves, one after another.
std::vector<int> SolvesOf(const OptimalControlProblem& problem,
                          const OptimalControlOptions& options, OptimalControlResult* result) {
  std::vector<int> solves;
  *result = SolveOptimalControl(problem, options, std::nullopt, {},
                                [&solves](const SolverIteration& iteration) {
                                  if (iteration.number == 0) solves.push_back(0);
                                  solves.back() = iteration.number;
                                });
  return solves;
}

TEST(CoarseFirst, ALargeProblemIsSolvedFromASolutionOnFewerKnots) {
  const auto problem = Goddard(0.6);
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {600};  // 4208 variables
  OptimalControlResult direct, nested;
  options.coarse_first = false;
  ASSERT_EQ(SolvesOf(*problem, options, &direct).size(), 1U);
  options.coarse_first = true;
  const std::vector<int> iterations = SolvesOf(*problem, options, &nested);
  ASSERT_EQ(iterations.size(), 2U);
  EXPECT_LT(iterations[1], direct.iterations);
  EXPECT_EQ(nested.iterations, iterations[0] + iterations[1]);
  EXPECT_EQ(nested.refinements, 0);
  EXPECT_FALSE(nested.dual_start);
  EXPECT_EQ(nested.trajectory.phases[0].mesh, UniformMesh(600));
  ASSERT_TRUE(nested.succeeded()) << nested.message;
  EXPECT_NEAR(nested.objective, direct.objective, 1e-8);
}

TEST(CoarseFirst, ASmallProblemIsSolvedAtOnce) {
  OptimalControlResult result;
  EXPECT_EQ(SolvesOf(*Goddard(0.6), {}, &result).size(), 1U);
}

/// Ipopt, which claims that small programs are infeasible.
class FailsOnSmallPrograms : public NonlinearSolver {
 public:
  std::string name() const override { return "fails on small programs"; }
  bool has_multipliers() const override { return true; }
  SolverResult Solve(NonlinearProgram* program, const SolverGuess& guess,
                     const SolverOptions& options, const CancellationToken& cancellation,
                     const std::function<void(const SolverIteration&)>& log) const override {
    SolverResult result = IpoptSolver().Solve(program, guess, options, cancellation, log);
    if (program->num_variables() < 2000) result.status = SolverStatus::kInfeasible;
    return result;
  }
};

TEST(CoarseFirst, IfTheCoarseSolveFailsTheGuessesAreTheStart) {
  const auto problem = Goddard(0.6);
  const FailsOnSmallPrograms solver;
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {600};
  options.nonlinear_solver = &solver;
  OptimalControlResult direct, nested;
  options.coarse_first = false;
  SolvesOf(*problem, options, &direct);
  options.coarse_first = true;
  const std::vector<int> iterations = SolvesOf(*problem, options, &nested);
  ASSERT_EQ(iterations.size(), 2U);
  EXPECT_EQ(iterations[1], direct.iterations);
  EXPECT_EQ(nested.objective, direct.objective);
}

TEST(CoarseFirst, IsNoMatterWhereAMotionIsGiven) {
  const auto problem = Goddard(0.6);
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {600};
  const OptimalControlResult cold = SolveOptimalControl(*problem, options);
  int solves = 0;
  const auto count = [&](const SolverIteration& iteration) { solves += iteration.number == 0; };
  SolveOptimalControl(*problem, options, cold.trajectory, {}, count);
  EXPECT_EQ(solves, 1);
  EXPECT_TRUE(SolveOptimalControl(*problem, Store(*problem, cold), options, {}, count).dual_start);
  EXPECT_EQ(solves, 2);
}

TEST(CoarseFirst, CancelledOnTheCoarseMeshGivesItsTrajectory) {
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {600};
  bool cancelled = false;
  const OptimalControlResult result = SolveOptimalControl(
      *Goddard(0.6), options, std::nullopt, CancellationToken([&] { return !cancelled; }),
      [&](const SolverIteration&) { cancelled = true; });
  EXPECT_EQ(result.status, SolverStatus::kCancelled);
  ASSERT_EQ(result.trajectory.phases.size(), 1U);
  EXPECT_EQ(result.trajectory.phases[0].mesh.size(), 121U);
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
