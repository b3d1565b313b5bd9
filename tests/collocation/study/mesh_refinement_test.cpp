#include "collocation/study/mesh_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

std::vector<MeshError> ErrorsOf(const std::vector<double>& values) {
  std::vector<MeshError> errors;
  for (const double value : values) errors.push_back({value, 0, 0});
  return errors;
}

TEST(Coarse, HasEveryFifthKnotButAtLeastFourIntervals) {
  EXPECT_EQ(Coarse(UniformMesh(10000)).size(), 2001U);
  EXPECT_EQ(Coarse(UniformMesh(3)), UniformMesh(3));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> length(0.1, 10);
  for (int intervals = 4; intervals < 60; ++intervals) {
    Mesh mesh = {0};
    for (int i = 0; i < intervals; ++i) mesh.push_back(mesh.back() + length(random));
    for (double& knot : mesh) knot /= mesh.back();
    const Mesh coarse = Coarse(mesh);
    EXPECT_EQ(coarse.size() - 1, std::max<std::size_t>(intervals / 5, 4));
    EXPECT_EQ(coarse.front(), 0);
    EXPECT_EQ(coarse.back(), mesh.back());
    EXPECT_TRUE(std::is_sorted(coarse.begin(), coarse.end()));
    EXPECT_TRUE(std::includes(mesh.begin(), mesh.end(), coarse.begin(), coarse.end()));
  }
}

TEST(Refined, SplitsWhatIsAboveTheToleranceAndMergesWhatStaysFarBelow) {
  const Mesh mesh = {0, 0.1, 0.2, 0.3, 0.4, 0.6, 1};
  // Of order 2 the error grows with the cube of the length: eight times for twice the length.
  const auto errors = ErrorsOf({1e-4, 1e-4, 1.3e-2, 1e-4, 8e-1, 20});
  const MeshRule keep{1e-2, 2, false};
  EXPECT_EQ(Refined(mesh, errors, keep).size(), mesh.size() + 1 + 3 + 3);
  const MeshRule coarsen{1e-2, 2, true};
  const Mesh merged = Refined(mesh, errors, coarsen);
  EXPECT_EQ(merged.size(), mesh.size() + 1 + 3 + 3 - 1);
  EXPECT_EQ(merged[1], 0.2);  // 8e-4 is less than a tenth of the tolerance
  EXPECT_NEAR(merged[2], 0.25, 1e-15);
  // 1.6e-3 is not.
  EXPECT_EQ(Refined({0, 0.5, 1}, ErrorsOf({2e-4, 1e-5}), coarsen).size(), 3U);
  // A short interval beside a long one: 1e-6 of a tenth of the length is 1.3e-3 of the whole.
  EXPECT_EQ(Refined({0, 0.1, 1.1 - 0.1}, ErrorsOf({1e-6, 0}), coarsen).size(), 2U);
  EXPECT_EQ(Refined({0, 0.1, 1}, ErrorsOf({2e-6, 0}), coarsen).size(), 3U);
}

/// x' = u - x with the least half integral of x^2 + u^2 over 40 s: two layers of about 1 s.
OptimalControlResult TwoLayers(bool coarsen) {
  OptimalControlProblem problem("two layers");
  Phase& phase = problem.AddPhase("only");
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u");
  phase.SetDuration(40);
  phase.SetDynamics(FunctionOf([](auto y, auto force) { return force - y; }), {x, u});
  phase.Fix(x, 1.5, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.AddIntegralCost(
      "squares", FunctionOf([](auto y, auto force) { return y * y + force * force; }), {x, u}, 0.5);
  OptimalControlOptions options;
  options.intervals = {120};
  options.mesh_tolerance = 1e-6;
  options.coarsen = coarsen;
  options.solver.tolerance = 1e-10;
  return SolveOptimalControl(problem, options);
}

TEST(Coarsening, NeedsFewerIntervalsForTheSameErrorBetweenBoundaryLayers) {
  // x is 1.5 e^(-w t) in one layer and e^(-w (40 - t)) in the other, w = sqrt 2, u = x' + x.
  const double w = std::sqrt(2.0);
  const double optimum = (1.5 * 1.5 * (1 + (1 - w) * (1 - w)) + 1 + (1 + w) * (1 + w)) / (4 * w);
  const OptimalControlResult fine = TwoLayers(false);
  const OptimalControlResult coarsened = TwoLayers(true);
  for (const OptimalControlResult* result : {&fine, &coarsened}) {
    ASSERT_TRUE(result->succeeded()) << result->message;
    EXPECT_GT(result->refinements, 0);
    EXPECT_LE(result->mesh_error, 1e-6);
    EXPECT_NEAR(result->objective, optimum, 1e-6);
  }
  const auto intervals = [](const OptimalControlResult& result) {
    return result.trajectory.phases[0].mesh.size() - 1;
  };
  EXPECT_LT(intervals(coarsened), 0.75 * intervals(fine)) << intervals(fine);
}

TEST(Knots, AreAddedAroundWideJumpsAndKeptAroundNarrowOnes) {
  ControlJump wide;
  wide.begin = 0.2;
  wide.end = 0.4;
  wide.share = 0.21;
  ControlJump narrow = wide;
  narrow.begin = 0.6;
  narrow.end = 0.7;
  const Mesh old = {0, 0.2, 0.3, 0.4, 0.6, 0.65, 0.7, 1};
  const Mesh mesh = WithKnotsAtJumps({0, 0.2, 0.3, 0.4, 0.5, 1}, old, {wide, narrow}, 0.15);
  // At 0.21 + 0.2 / 32 and 0.21 + 0.2 / 8; the first on the left is 0.00375 from the end.
  const Mesh expected = {0, 0.2, 0.20375, 0.21625, 0.235, 0.4, 0.5, 0.6, 0.65, 0.7, 1};
  ASSERT_EQ(mesh.size(), expected.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) EXPECT_NEAR(mesh[i], expected[i], 1e-15) << i;
}

/// 1 m in the least time, from rest to rest, with a force of -2 to 1 N on 1 kg.
OptimalControlResult Quickest(double jump_tolerance) {
  OptimalControlProblem problem("quickest");
  Phase& phase = problem.AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("force", {-2, 1});
  phase.SetDuration({0.5, 5});
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  problem.AddCost({phase.duration(), At::kEnd});
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {10};
  options.jump_tolerance = jump_tolerance;
  options.solver.tolerance = 1e-10;
  return SolveOptimalControl(problem, options);
}

/// The force is 1 until t, -2 for t / 2: 3/4 t^2 = 1.
TEST(Jumps, ASwitchingTimeIsFoundToWellWithinAnInterval) {
  const double time = 1.5 * std::sqrt(4.0 / 3);
  const OptimalControlResult plain = Quickest(0);
  ASSERT_TRUE(plain.succeeded()) << plain.message;
  EXPECT_TRUE(plain.jumps.empty());
  const OptimalControlResult result = Quickest(1e-3);
  ASSERT_TRUE(result.succeeded()) << result.message;
  ASSERT_EQ(result.jumps[0].size(), 1U);
  const ControlJump& jump = result.jumps[0][0];
  EXPECT_NEAR(jump.share, 2.0 / 3, 1e-4);
  EXPECT_LT(jump.end - jump.begin, 1e-3);
  EXPECT_NEAR(jump.before, 1, 1e-2);
  EXPECT_NEAR(jump.after, -2, 1e-2);
  EXPECT_LT(std::abs(result.objective - time), std::abs(plain.objective - time) / 1000)
      << plain.objective << ", " << result.objective;
  EXPECT_LT(result.trajectory.phases[0].mesh.size(), 40U);
}

/// 1 m in 3 s with the least fuel: forward for t, nothing, backward for t, with t (3 - t) = 1.
TEST(Jumps, OfTwoControlsAreFound) {
  OptimalControlProblem problem("least fuel");
  Phase& phase = problem.AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable forward = phase.AddControl("forward", {0, 1});
  const Variable backward = phase.AddControl("backward", {0, 1});
  phase.SetDuration(3);
  phase.SetDynamics(FunctionOf([](auto f, auto b) { return f - b; }), {forward, backward});
  for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.AddIntegralCost("fuel", FunctionOf([](auto f, auto b) { return f + b; }),
                        {forward, backward});
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  options.intervals = {15};
  options.jump_tolerance = 1e-3;
  options.solver.tolerance = 1e-10;
  const OptimalControlResult result = SolveOptimalControl(problem, options);
  ASSERT_TRUE(result.succeeded()) << result.message;
  const double time = (3 - std::sqrt(5.0)) / 2;
  ASSERT_EQ(result.jumps[0].size(), 2U);
  EXPECT_EQ(result.jumps[0][0].control, forward.index);
  EXPECT_NEAR(3 * result.jumps[0][0].share, time, 1e-4);
  EXPECT_EQ(result.jumps[0][1].control, backward.index);
  EXPECT_NEAR(3 * result.jumps[0][1].share, 3 - time, 1e-4);
  EXPECT_NEAR(result.objective, 2 * time, 1e-6);
}

TEST(Jumps, AreNotSeenInASmoothControl) {
  PhaseTrajectory motion;
  motion.duration = 1;
  motion.mesh = UniformMesh(20);
  motion.scheme = Trapezoidal();
  motion.controls.resize(2, 21);
  for (int k = 0; k <= 20; ++k) {
    const double t = k / 20.0;
    motion.controls(0, k) = std::tanh(20 * (t - 0.5));  // a layer that the mesh resolves
    motion.controls(1, k) = 3 + 1e-9 * (k % 7);
  }
  EXPECT_TRUE(FindJumps({{motion}, {}})[0].empty());
  for (int k = 0; k <= 20; ++k) motion.controls(0, k) = k < 7 ? -1 : 1;
  const auto jumps = FindJumps({{motion}, {}});
  ASSERT_EQ(jumps[0].size(), 1U);
  EXPECT_NEAR(jumps[0][0].share, 0.325, 1e-12);
}

}  // namespace
}  // namespace possibility::collocation
