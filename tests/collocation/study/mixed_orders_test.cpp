// Coordinates of different orders in one phase.
#include <gtest/gtest.h>

#include <cmath>

#include "collocation/study/optimal_control.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"

namespace possibility::collocation {
namespace {

constexpr double kLag = 0.2;  // s

/// A block of 1 kg is moved by 1 m in 1 s from rest to rest. Its motor follows the command u with a
/// lag: force' = (u - force) / lag, without force at both ends. The least integral of u^2.
struct LaggingBlock {
  LaggingBlock()
      : problem("lagging block"),
        move(problem.AddPhase("move", 2)),
        force(move.AddCoordinateOfOrder(1, "force", {-100, 100})),
        x(move.AddCoordinate("x")),
        u(move.AddControl("command")) {
    move.SetDuration(1);
    move.SetDynamics(FunctionOf([](auto f, auto command) {
                       return std::array{(command - f) / kLag, f};
                     }),
                     {force, u});
    for (const At end : {At::kStart, At::kEnd}) {
      move.Fix(move.Rate(x), 0, end);
      move.Fix(force, 0, end);
    }
    move.Fix(x, 0, At::kStart);
    move.Fix(x, 1, At::kEnd);
    move.AddIntegralCost("effort", FunctionOf([](auto c) { return c * c; }), {u});
  }

  OptimalControlResult Solve(const TranscriptionScheme& scheme, int intervals) const {
    OptimalControlOptions options;
    options.scheme = scheme;
    options.intervals = {intervals};
    options.solver.tolerance = 1e-11;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem;
  Phase& move;
  Variable force, x, u;
};

/// u = f + lag f', and the integral of f f' vanishes. The Euler-Lagrange equation of f^2 + lag^2
/// f'^2 with the integrals of f and (1 - t) f given is f - lag^2 f'' = m (t - 1/2), so f = m (s -
/// sinh(s / lag) / (2 sinh(1 / (2 lag)))), s = t - 1/2, and the optimum is -m.
double LeastEffortWithLag() {
  return 1 / (1.0 / 12 - kLag / (2 * std::tanh(1 / (2 * kLag))) + kLag * kLag);
}

double ForceWithLag(double t) {
  const double s = t - 0.5;
  return -LeastEffortWithLag() * (s - std::sinh(s / kLag) / (2 * std::sinh(1 / (2 * kLag))));
}

TEST(MixedOrders, APositionBesideALaggingForceHasItsClosedForm) {
  const LaggingBlock block;
  const OptimalControlResult result = block.Solve(GaussLobatto(4), 32);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, LeastEffortWithLag(), 1e-6 * LeastEffortWithLag());
  for (const double t : {0.1, 0.33, 0.5, 0.9}) {
    EXPECT_NEAR(result.Value(block.force, t), ForceWithLag(t), 3e-5) << t;
    EXPECT_NEAR(result.Value(block.move.Rate(block.x, 2), t), ForceWithLag(t), 3e-5) << t;
    EXPECT_NEAR(result.Value(block.move.Rate(block.force), t),
                (ForceWithLag(t + 1e-5) - ForceWithLag(t - 1e-5)) / 2e-5, 3e-3)
        << t;
  }
  // x, x', x'', force, force' and u at 97 points.
  EXPECT_EQ(result.solver.x.size(), 6 * 97);
}

TEST(MixedOrders, KeepTheOrderOfConvergence) {
  for (const auto& [scheme, order] : {std::pair{Trapezoidal(), 2.0},
                                      {HermiteSimpson(), 4.0},
                                      {CompressedHermiteSimpson(), 4.0}}) {
    const LaggingBlock block;
    const double coarse = std::abs(block.Solve(scheme, 32).objective - LeastEffortWithLag());
    const double fine = std::abs(block.Solve(scheme, 64).objective - LeastEffortWithLag());
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << scheme.name << ": " << coarse;
  }
}

TEST(MixedOrders, DerivativesBeyondACoordinatesOrderAreSlopes) {
  const LaggingBlock block;
  const OptimalControlResult result = block.Solve(HermiteSimpson(), 10);
  const PhaseTrajectory& motion = result.trajectory.phases[0];
  for (const double s : {0.03, 0.47, 0.81}) {
    const double step = 1e-4;
    EXPECT_NEAR(
        motion.Coordinates(s, 2)[0],
        (motion.Coordinates(s + step, 1)[0] - motion.Coordinates(s - step, 1)[0]) / (2 * step),
        1e-6);
  }
  EXPECT_EQ(motion.coordinates[2](0, 3), motion.Coordinates(motion.PointShare(3), 2)[0]);
}

TEST(MixedOrders, AreStoredAndStartTheSameProblem) {
  const LaggingBlock block;
  const OptimalControlResult cold = block.Solve(HermiteSimpson(), 20);
  const models::TemporaryFolder folder;
  WriteSolution(folder.path() / "s.json", Store(block.problem, cold));
  const StoredSolution stored = ReadSolution(folder.path() / "s.json");
  EXPECT_EQ(stored.phases[0].orders, (std::vector<int>{1, 2}));
  const OptimalControlResult again = SolveOptimalControl(block.problem, stored);
  ASSERT_TRUE(again.succeeded()) << again.message;
  EXPECT_TRUE(again.dual_start);
  EXPECT_NEAR(again.objective, cold.objective, 1e-7 * cold.objective);

  // The same names, but all of order 2.
  OptimalControlProblem other("other");
  Phase& phase = other.AddPhase("move", 2);
  phase.AddCoordinate("force");
  phase.AddCoordinate("x");
  phase.AddControl("command");
  EXPECT_EQ(MessageOf([&] { SolveOptimalControl(other, stored); }),
            "other: phase 'move': 'force' of the stored solution is of order 1, expected 2");
}

TEST(MixedOrders, ThatAreThoseOfThePhaseCountAsNone) {
  OptimalControlProblem problem("drift");
  Phase& phase = problem.AddPhase("only", 2);
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  phase.Fix(x, 0, At::kStart);
  phase.AddIntegralCost("shake", FunctionOf([](auto a) { return a * a; }), {phase.Rate(x, 2)});
  StoredSolution stored = Store(problem, SolveOptimalControl(problem));
  stored.phases[0].orders = {2};
  const models::TemporaryFolder folder;
  WriteSolution(folder.path() / "s.json", stored);
  const StoredSolution read = ReadSolution(folder.path() / "s.json");
  EXPECT_TRUE(read.phases[0].orders.empty());
  EXPECT_TRUE(SolveOptimalControl(problem, read).succeeded());
}

TEST(MixedOrders, BeyondThePhasesAreRefused) {
  LaggingBlock block;
  EXPECT_EQ(MessageOf([&] { block.move.AddCoordinateOfOrder(3, "jerk"); }),
            "lagging block: phase 'move': 'jerk': expected an order from 1 to 2, got 3");
  EXPECT_EQ(MessageOf([&] { block.move.Rate(block.force, 2); }),
            "lagging block: phase 'move': 'force' has no derivative of order 2");
}

}  // namespace
}  // namespace possibility::collocation
