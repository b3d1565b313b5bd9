// Schemes without values at knots: Gauss and Legendre's, Radau's.
#include <gtest/gtest.h>

#include <cmath>

#include "collocation/study/optimal_control.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "tests/collocation/study/moved_block.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"

namespace possibility::collocation {
namespace {

class EveryOpenScheme : public ::testing::TestWithParam<TranscriptionScheme> {};

/// The force is 1 until 2/3 of the time and -2 from then on: 3/4 t^2 = 1 for the first part.
TEST_P(EveryOpenScheme, AForceThatJumpsAtAKnotIsExact) {
  MovedBlock block({0.5, 5});
  block.move.Bound(block.u, {-2, 1});
  block.problem.AddCost({block.move.duration(), At::kEnd});
  const OptimalControlResult result = block.Solve(GetParam(), {0, 1.0 / 3, 2.0 / 3, 1});
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, 1.5 * std::sqrt(4.0 / 3), 1e-7);
  const PhaseTrajectory& motion = result.trajectory.phases[0];
  EXPECT_NEAR(motion.Controls(MeshPlace{1, 1.0})[0], 1, 1e-6);
  EXPECT_NEAR(motion.Controls(MeshPlace{2, 0.0})[0], -2, 1e-6);
  EXPECT_LT(result.mesh_error, 1e-6);
  // With values at knots the force cannot jump there.
  EXPECT_GT(block.Solve(Trapezoidal(), {0, 1.0 / 3, 2.0 / 3, 1}).objective,
            result.objective + 1e-2);
}

/// The least effort is 12, with a force of 6 - 12 t: bounds at an end bind the polynomial there.
TEST_P(EveryOpenScheme, BoundsAtAnEndHoldWhereNoVariableIs) {
  MovedBlock block({1, 1});
  block.move.AddIntegralCost("effort", FunctionOf([](auto f) { return f * f; }), {block.u});
  const OptimalControlResult free = block.Solve(GetParam(), UniformMesh(3));
  EXPECT_NEAR(free.objective, 12, 1e-8);
  EXPECT_LT(free.mesh_error, 1e-8);
  for (const double t : {0.0, 0.2, 1.0}) EXPECT_NEAR(free.Value(block.u, t), 6 - 12 * t, 1e-6);
  block.move.Bound(block.u, {-20, 4}, At::kStart);
  block.move.Bound(block.u, {4, 20}, At::kStart);
  block.move.Bound(block.move.Rate(block.x, 2), {-5, kInfinity}, At::kEnd);
  const OptimalControlResult bound = block.Solve(GetParam(), UniformMesh(3));
  ASSERT_TRUE(bound.succeeded()) << bound.message;
  EXPECT_NEAR(bound.Value(block.u, 0), 4, 1e-8);
  EXPECT_NEAR(bound.Value(block.u, 1), -5, 1e-6);
  EXPECT_GT(bound.objective, 12.01);
  block.move.Fix(block.u, 5, At::kStart);
  EXPECT_EQ(MessageOf([&] { block.Solve(GetParam(), UniformMesh(3)); }),
            "block: move, knot 0 (t = 0 of the duration): force: contradictory bounds [5, 4]");
}

TEST_P(EveryOpenScheme, IsStoredAndStartsTheSameProblem) {
  MovedBlock block({1, 1});
  block.move.AddIntegralCost("effort", FunctionOf([](auto f) { return f * f; }), {block.u});
  const OptimalControlResult cold = block.Solve(GetParam(), UniformMesh(4));
  const models::TemporaryFolder folder;
  WriteSolution(folder.path() / "s.json", Store(block.problem, cold));
  const StoredSolution stored = ReadSolution(folder.path() / "s.json");
  EXPECT_EQ(stored.trajectory.phases[0].scheme.value_at_end, GetParam().value_at_end);
  OptimalControlOptions options;
  options.scheme = GetParam();
  options.intervals = {7};
  const OptimalControlResult again = SolveOptimalControl(block.problem, stored, options);
  ASSERT_TRUE(again.succeeded()) << again.message;
  EXPECT_TRUE(again.dual_start);
  EXPECT_NEAR(again.objective, 12, 1e-7);
}

TEST_P(EveryOpenScheme, HasNoRatesOfControls) {
  MovedBlock block({1, 1});
  block.move.BoundRate(block.u, {-1, 1});
  EXPECT_EQ(
      MessageOf([&] { block.Solve(GetParam(), UniformMesh(3)); }),
      "block: phase 'move': a cost or bound of a control's rate does not go with the scheme '" +
          GetParam().name + "', whose controls jump at knots");
}

INSTANTIATE_TEST_SUITE_P(OpenSchemes, EveryOpenScheme,
                         ::testing::Values(LegendreGauss(2), LegendreGauss(3), FlippedRadau(2),
                                           FlippedRadau(3)),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace possibility::collocation
