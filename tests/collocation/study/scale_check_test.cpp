#include "collocation/study/scale_check.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

/// A block of 1 kg, 1 m in 1 s from rest to rest; the least integral of u^2 is 12.
struct ScaledBlock {
  ScaledBlock(double scale, double weight)
      : problem("block"),
        phase(problem.AddPhase("move", 2)),
        x(phase.AddCoordinate("x", {}, scale)),
        u(phase.AddControl("force", {-20, 20}, scale)) {
    phase.SetScale(phase.Rate(x), scale);
    phase.SetScale(phase.Rate(x, 2), scale);
    phase.SetDuration(1);
    phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
    for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
    phase.Fix(x, 0, At::kStart);
    phase.Fix(x, 1, At::kEnd);
    phase.AddIntegralCost(
        "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u},
        weight);
  }

  OptimalControlProblem problem;
  Phase& phase;
  Variable x, u;
};

TEST(Scales, OfAnySensibleSizeGiveTheSameOptimum) {
  for (const double scale : {1e-2, 1.0, 1e2, 1e4}) {
    const OptimalControlResult result = SolveOptimalControl(ScaledBlock(scale, 1).problem);
    EXPECT_EQ(result.status, SolverStatus::kSolved) << scale;
    EXPECT_NEAR(result.objective, 12, 1e-4) << scale;
  }
}

TEST(Scales, ThatHideAQuantityAreRefusedByName) {
  const ScaledBlock block(1e9, 1);
  try {
    SolveOptimalControl(block.problem);
    FAIL() << "a bound of 1 counts as 1e-9 and would be met by 0";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "block: phase 'move': the scale of 'x' is 1e+09, but its bounds reach 1 only: the "
              "tolerance of 1e-08 times the scale hides them");
  }
}

TEST(ObjectiveSize, ASmallObjectiveIsMinimisedAsWellAsALargeOne) {
  for (const double weight : {1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e6, 1e12}) {
    const OptimalControlResult result = SolveOptimalControl(ScaledBlock(1, weight).problem);
    EXPECT_EQ(result.status, SolverStatus::kSolved) << weight;
    EXPECT_NEAR(result.objective / weight, 12, 1e-4) << weight;
  }
}

TEST(ObjectiveSize, AnOptimumOfZeroIsNotSoughtAgain) {
  // The force may be zero: the block only has to be somewhere.
  OptimalControlProblem problem("rest");
  Phase& phase = problem.AddPhase("stay", 2);
  const Variable x = phase.AddCoordinate("x", {0, 1});
  const Variable u = phase.AddControl("force", {-20, 20});
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Fix(phase.Rate(x), 0, At::kStart);
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  phase.Guess(u, 5);
  const OptimalControlResult result = SolveOptimalControl(problem);
  EXPECT_EQ(result.status, SolverStatus::kSolved);
  EXPECT_NEAR(result.objective, 0, 1e-8);
  EXPECT_LT(result.iterations, 20);
}

}  // namespace
}  // namespace possibility::collocation
