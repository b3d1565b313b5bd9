// What a solved motion is: a minimum, or merely stationary.
#include <gtest/gtest.h>

#include <cmath>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

OptimalControlOptions WithSecondOrderCheck() {
  OptimalControlOptions options;
  options.second_order_check = true;
  return options;
}

/// A unit mass from rest to rest in 1 s, with a cost of sign u^2. Where distance is 0, standing
/// still is stationary.
struct Push {
  Push(double sign, double distance) : phase(problem.AddPhase("move", 2)) {
    const Variable x = phase.AddCoordinate("x");
    const Variable u = phase.AddControl("force", {-20, 20});
    phase.SetDuration(1);
    phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
    for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
    phase.Fix(x, 0, At::kStart);
    phase.Fix(x, distance, At::kEnd);
    phase.AddIntegralCost("effort", FunctionOf([sign](auto force) { return sign * force * force; }),
                          {u});
  }
  OptimalControlProblem problem{"push"};
  Phase& phase;
};

TEST(SecondOrderCheckTest, StandingStillForARewardOfEffortIsASaddle) {
  const Push push(-1, 0);
  const OptimalControlResult result = SolveOptimalControl(push.problem, WithSecondOrderCheck());
  EXPECT_EQ(result.status, SolverStatus::kSolved);
  EXPECT_NEAR(result.objective, 0, 1e-9);
  EXPECT_EQ(result.stationary_point, StationaryPoint::kSaddle);
  EXPECT_EQ(result.message,
            "solved, but not a minimum: motions beside it cost less (to second order)");
}

TEST(SecondOrderCheckTest, AMoveOfLeastEffortIsAMinimumOnEveryMesh) {
  const Push push(1, 1);
  for (const TranscriptionScheme& scheme :
       {Trapezoidal(), HermiteSimpson(), CompressedHermiteSimpson()}) {
    for (const int intervals : {2, 20, 300}) {
      OptimalControlOptions options = WithSecondOrderCheck();
      options.scheme = scheme;
      options.intervals = {intervals};
      const OptimalControlResult result = SolveOptimalControl(push.problem, options);
      EXPECT_EQ(result.stationary_point, StationaryPoint::kMinimum)
          << scheme.name << ", " << intervals;
      EXPECT_EQ(result.message, "solved");
      EXPECT_GT(result.times.second_order, 0);
    }
  }
}

TEST(SecondOrderCheckTest, OnlyTheLastMeshIsChecked) {
  Push push(1, 1);
  OptimalControlOptions options = WithSecondOrderCheck();
  options.scheme = Trapezoidal();
  options.intervals = {4};
  options.mesh_tolerance = 1e-2;
  const OptimalControlResult result = SolveOptimalControl(push.problem, options);
  EXPECT_GT(result.refinements, 0);
  EXPECT_EQ(result.stationary_point, StationaryPoint::kMinimum);
}

TEST(SecondOrderCheckTest, WithoutACheckNothingIsKnown) {
  const Push push(1, 1);
  const OptimalControlResult result = SolveOptimalControl(push.problem);
  EXPECT_EQ(result.stationary_point, StationaryPoint::kUnknown);
  EXPECT_EQ(result.times.second_order, 0);
}

/// An upright pendulum, stiffly held by a cost on its angle or let alone: its fall costs nothing,
/// and what it does upright is paid for with torque.
TEST(SecondOrderCheckTest, BalancingIsAMinimumOnlyIfFallingCosts) {
  for (const auto& [reward, kind] :
       {std::pair{0.0, StationaryPoint::kMinimum}, {10.0, StationaryPoint::kSaddle}}) {
    OptimalControlProblem problem("balance");
    Phase& phase = problem.AddPhase("stand", 2);
    const Variable q = phase.AddCoordinate("q");
    const Variable u = phase.AddControl("torque");
    phase.SetDuration(2);
    phase.SetDynamics(
        Differentiated<2, 1>([](const auto& z, auto* a) { (*a)[0] = z[1] + 2.0 * sin(z[0]); }),
        {q, u});
    phase.Fix(q, 0, At::kStart);
    phase.Fix(phase.Rate(q), 0, At::kStart);
    phase.AddIntegralCost("effort", Differentiated<2, 1>([reward = reward](const auto& z, auto* c) {
                            (*c)[0] = z[1] * z[1] + reward * (cos(z[0]) - 1.0);
                          }),
                          {q, u});
    const OptimalControlResult result = SolveOptimalControl(problem, WithSecondOrderCheck());
    ASSERT_TRUE(result.succeeded()) << result.message;
    EXPECT_EQ(result.stationary_point, kind) << reward;
  }
}

}  // namespace
}  // namespace possibility::collocation
