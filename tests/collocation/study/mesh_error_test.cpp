#include "collocation/study/mesh_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

std::shared_ptr<Function> SquaredForce() {
  return Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; });
}

std::shared_ptr<Function> ForceItself() {
  return Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; });
}

/// A block of 1 kg with a force, from rest to rest.
struct Block {
  Block(double distance, Bounds force)
      : problem("block"),
        phase(problem.AddPhase("move", 2)),
        x(phase.AddCoordinate("x")),
        u(phase.AddControl("force", force)) {
    phase.SetDynamics(ForceItself(), {u});
    for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
    phase.Fix(x, 0, At::kStart);
    phase.Fix(x, distance, At::kEnd);
  }

  OptimalControlResult Solve(const TranscriptionScheme& scheme, int intervals,
                             double mesh_tolerance = 0) const {
    OptimalControlOptions options;
    options.scheme = scheme;
    options.intervals = {intervals};
    options.mesh_tolerance = mesh_tolerance;
    options.max_refinements = 12;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem;
  Phase& phase;
  Variable x, u;
};

/// The least integral of u^2 over 1 m in 1 s is 12.
struct LeastEffort : Block {
  LeastEffort() : Block(1, {-100, 100}) {
    phase.SetDuration(1);
    phase.AddIntegralCost("effort", SquaredForce(), {u});
  }
};

TEST(MeshErrors, SeeACostThatTheSchemesRuleMissesByHalf) {
  // The trapezoidal rule sums u^2 at the knots only.
  const LeastEffort block;
  const OptimalControlResult coarse = block.Solve(Trapezoidal(), 2);
  ASSERT_TRUE(coarse.succeeded());
  EXPECT_GT(std::abs(coarse.objective - 12), 3);
  EXPECT_LT(coarse.mesh_errors.dynamics, 1e-6);
  EXPECT_GT(coarse.mesh_errors.cost, 0.1);
  const OptimalControlResult fine = block.Solve(Trapezoidal(), 2, 1e-5);
  EXPECT_LE(fine.mesh_error, 1e-5);
  EXPECT_NEAR(fine.objective, 12, 0.01);
}

TEST(MeshErrors, SeeAnIntegralThatTheSchemesRuleMisses) {
  // With at most 12 N^2 s the block can go 1 m in 1 s, no farther. The trapezoidal rule misses half
  // of the effort, so on two intervals the block seems to go farther.
  OptimalControlProblem farther("farther");
  Phase& phase = farther.AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("force");
  phase.SetDynamics(ForceItself(), {u});
  for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
  phase.Fix(x, 0, At::kStart);
  phase.SetDuration(1);
  phase.ConstrainIntegral("effort", SquaredForce(), {u}, {0, 12}, 12);
  farther.AddCost({x, At::kEnd}, -1);
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {2};
  const OptimalControlResult coarse = SolveOptimalControl(farther, options);
  ASSERT_TRUE(coarse.succeeded()) << coarse.message;
  EXPECT_GT(std::abs(coarse.objective + 1), 0.1);
  EXPECT_GT(coarse.mesh_errors.inequalities, 0.1);
  options.mesh_tolerance = 1e-5;
  options.max_refinements = 12;
  const OptimalControlResult fine = SolveOptimalControl(farther, options);
  EXPECT_LE(fine.mesh_error, 1e-5);
  EXPECT_NEAR(fine.objective, -1, 1e-3);
}

TEST(MeshErrors, AreZeroWhereTheSchemeIsExact) {
  // The force is linear in time, its square quadratic: Simpson's rule is exact.
  const OptimalControlResult result = LeastEffort().Solve(HermiteSimpson(), 3);
  EXPECT_NEAR(result.objective, 12, 1e-8);
  EXPECT_LT(result.mesh_error, 1e-9);
}

TEST(MeshErrors, SeeACoordinateBeyondItsBoundBetweenTheKnots) {
  // Bryson and Denham: from (0, 1 m/s) back to (0, -1 m/s) in 1 s below 1/9 m; the least half
  // integral of u^2 is 4.
  OptimalControlProblem problem("bryson denham");
  Phase& phase = problem.AddPhase("arc", 2);
  const Variable x = phase.AddCoordinate("x", {-kInfinity, 1.0 / 9});
  const Variable u = phase.AddControl("u");
  phase.SetDynamics(ForceItself(), {u});
  phase.SetDuration(1);
  for (const At end : {At::kStart, At::kEnd}) {
    phase.Fix(x, 0, end);
    phase.Fix(phase.Rate(x), end == At::kStart ? 1 : -1, end);
  }
  phase.AddIntegralCost("effort", SquaredForce(), {u}, 0.5);
  OptimalControlOptions options;
  options.intervals = {4};
  const OptimalControlResult coarse = SolveOptimalControl(problem, options);
  ASSERT_TRUE(coarse.succeeded());
  EXPECT_GT(std::abs(coarse.objective - 4), 0.005);
  EXPECT_GT(coarse.mesh_errors.inequalities, 1e-5);
  options.mesh_tolerance = 1e-7;
  options.max_refinements = 12;
  const OptimalControlResult fine = SolveOptimalControl(problem, options);
  EXPECT_LE(fine.mesh_error, 1e-7);
  EXPECT_NEAR(fine.objective, 4, 2e-3);
}

TEST(MeshErrors, SeeAControlBeyondItsBoundBetweenTheNodes) {
  // The least time with +-1 N: the force jumps, here within an interval; a parabola through three
  // nodes overshoots there.
  Block block(1, {-1, 1});
  block.phase.Bound(block.phase.Rate(block.x), {-kInfinity, 0.8});
  block.phase.SetDuration(Bounds{0.5, 5});
  block.problem.AddCost({block.phase.duration(), At::kEnd});
  const OptimalControlResult result = block.Solve(HermiteSimpson(), 5);
  ASSERT_TRUE(result.succeeded());
  EXPECT_GT(result.mesh_errors.inequalities, 1e-3);
}

}  // namespace
}  // namespace possibility::collocation
