// Costs and bounds of the rates of controls, and controls that continue through phases.
#include <gtest/gtest.h>

#include <cmath>

#include "collocation/study/optimal_control.h"
#include "tests/collocation/study/moved_block.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

/// The least integral of u'^2: x''' vanishes at the ends, where the force is free, and x has the
/// degree 5. So u' = -60 t (1 - t), u = 5 - 30 t^2 + 20 t^3, and the integral is 120.
TEST(RateCost, OfAFreeForceIsThatOfTheClosedForm) {
  MovedBlock block({1, 1});
  block.move.AddRateCost(block.u);
  const OptimalControlResult result = block.Solve(GaussLobatto(4), UniformMesh(3));
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, 120, 1e-7);
  for (const double t : {0.0, 0.2, 0.55, 1.0}) {
    EXPECT_NEAR(result.Value(block.u, t), 5 - 30 * t * t + 20 * t * t * t, 1e-7) << t;
    EXPECT_NEAR(result.trajectory.phases[0].ControlRates(t)[0], -60 * t * (1 - t), 1e-6) << t;
  }
}

/// With a force of zero at both ends it is the motion of least jerk (Flash & Hogan 1985): 720.
TEST(RateCost, OfAForceFromZeroToZeroIsTheLeastJerk) {
  MovedBlock block({1, 1});
  block.move.AddRateCost(block.u);
  for (const At end : {At::kStart, At::kEnd}) block.move.Fix(block.u, 0, end);
  EXPECT_NEAR(block.Solve(GaussLobatto(4), UniformMesh(3)).objective, 720, 1e-6);
  // Straight lines follow the cubic force to the second order.
  const double coarse = block.Solve(Trapezoidal(), UniformMesh(30)).objective - 720;
  const double fine = block.Solve(Trapezoidal(), UniformMesh(60)).objective - 720;
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05) << coarse << ", " << fine;
  EXPECT_NEAR(block.Solve(HermiteSimpson(), UniformMesh(30)).objective, 720, 0.5);
}

/// 120 / T^5 + w T is least at T^6 = 600 / w.
TEST(RateCost, CountsSecondsWhereTheDurationIsFree) {
  MovedBlock block({0.5, 5});
  block.move.AddRateCost(block.u, 3);
  block.problem.AddCost({block.move.duration(), At::kEnd}, 3 * 600.0 / 64);
  const OptimalControlResult result = block.Solve(GaussLobatto(4), UniformMesh(3));
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.trajectory.phases[0].duration, 2, 1e-6);
  EXPECT_NEAR(result.objective, 3 * (120.0 / 32 + 600.0 / 64 * 2), 1e-6);
}

/// The quickest motion with |u'| <= 1 N/s and no force at the ends: u' is 1, -1, -1, 1 for a
/// quarter of the time each, each. With a = T / 4 the way is 2 a^3: T^3 = 32.
TEST(BoundRate, TheQuickestMotionHasItsClosedForm) {
  for (const TranscriptionScheme& scheme : {Trapezoidal(), HermiteSimpson()}) {
    MovedBlock block({1, 10});
    block.move.BoundRate(block.u, {-2, 1});
    block.move.BoundRate(block.u, {-1, 3});
    for (const At end : {At::kStart, At::kEnd}) block.move.Fix(block.u, 0, end);
    block.problem.AddCost({block.move.duration(), At::kEnd});
    const OptimalControlResult result = block.Solve(scheme, UniformMesh(8));
    ASSERT_TRUE(result.succeeded()) << result.message;
    EXPECT_NEAR(result.objective, std::cbrt(32.0), 1e-6) << scheme.name;
    EXPECT_LT(result.mesh_error, 1e-6) << scheme.name;
    for (const double share : {0.1, 0.4, 0.6, 0.9}) {
      const double expected = share < 0.25 || share > 0.75 ? 1 : -1;
      EXPECT_NEAR(result.trajectory.phases[0].ControlRates(share)[0], expected, 1e-5) << share;
    }
  }
}

/// Slopes of degree 2 are bounded at three points. Beyond the bound between them, the error shows.
TEST(BoundRate, IsExceededBetweenItsPointsByNoMoreThanTheMeshErrorSays) {
  MovedBlock block({1, 10});
  block.move.BoundRate(block.u, {-1, 1});
  for (const At end : {At::kStart, At::kEnd}) block.move.Fix(block.u, 0, end);
  block.problem.AddCost({block.move.duration(), At::kEnd});
  const OptimalControlResult result = block.Solve(GaussLobatto(4), UniformMesh(3));
  ASSERT_TRUE(result.succeeded()) << result.message;
  double greatest = 0;
  for (double s = 0; s <= 1; s += 0.01) {
    greatest = std::max(greatest, std::abs(result.trajectory.phases[0].ControlRates(s)[0]));
  }
  EXPECT_GT(greatest, 1.01);
  EXPECT_GT(result.mesh_errors.inequalities, 1e-3);
}

/// Two phases of 0.5 s push the block by 1 m with the least integral of u^2 in the first and twice
/// as much in the second: the force jumps by a half, unless it continues.
struct BlockInTwoPhases {
  BlockInTwoPhases() : problem("two pushes") {
    for (const char* name : {"first", "second"}) {
      Phase& phase = problem.AddPhase(name, 2);
      x.push_back(phase.AddCoordinate("x"));
      u.push_back(phase.AddControl("force"));
      phase.SetDuration(0.5);
      phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u.back()});
      phase.AddIntegralCost("effort", FunctionOf([](auto force) { return force * force; }),
                            {u.back()}, static_cast<double>(x.size()));
      phases.push_back(&phase);
    }
    problem.Continue({x[0], At::kEnd}, {x[1], At::kStart});
    problem.Continue({phases[0]->Rate(x[0]), At::kEnd}, {phases[1]->Rate(x[1]), At::kStart});
    phases[0]->Fix(x[0], 0, At::kStart);
    phases[0]->Fix(phases[0]->Rate(x[0]), 0, At::kStart);
    phases[1]->Fix(x[1], 1, At::kEnd);
    phases[1]->Fix(phases[1]->Rate(x[1]), 0, At::kEnd);
  }

  OptimalControlProblem problem;
  std::vector<Phase*> phases;
  std::vector<Variable> x, u;
};

TEST(ContinuedControls, DoNotJumpBetweenPhases) {
  BlockInTwoPhases jumping;
  const OptimalControlResult free = SolveOptimalControl(jumping.problem);
  ASSERT_TRUE(free.succeeded()) << free.message;
  // The costate of the velocity is continuous: 2 u before is 4 u after.
  const double before = free.trajectory.phases[0].Controls(1)[0];
  const double after = free.trajectory.phases[1].Controls(0)[0];
  EXPECT_GT(std::abs(before), 0.1);
  EXPECT_NEAR(before, 2 * after, 1e-6);

  BlockInTwoPhases held;
  held.problem.Continue({held.u[0], At::kEnd}, {held.u[1], At::kStart});
  held.phases[1]->Bound(held.u[1], {-kInfinity, 0.25}, At::kStart);
  held.phases[0]->Bound(held.u[0], {0.25, kInfinity}, At::kEnd);
  const OptimalControlResult result = SolveOptimalControl(held.problem);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.trajectory.phases[0].Controls(1)[0], 0.25, 1e-9);
  EXPECT_EQ(result.trajectory.phases[0].Controls(1)[0], result.trajectory.phases[1].Controls(0)[0]);
  EXPECT_GT(result.objective, free.objective);

  held.phases[1]->Bound(held.u[1], {0.5, kInfinity}, At::kStart);
  EXPECT_EQ(MessageOf([&] { SolveOptimalControl(held.problem); }),
            "two pushes: second, knot 0 (t = 0 of the duration): force: contradictory bounds [0.5, "
            "0.25]");
}

TEST(ControlRates, OfWhatIsNoControlAreRefused) {
  MovedBlock block({1, 1});
  EXPECT_EQ(MessageOf([&] { block.move.AddRateCost(block.x); }),
            "block: phase 'move': 'x' is no control: the derivatives of coordinates have costs and "
            "bounds of their own");
  EXPECT_EQ(MessageOf([&] { block.move.AddRateCost(block.u, std::nan("")); }),
            "block: phase 'move': the rate of 'force' has the weight nan");
  EXPECT_EQ(MessageOf([&] {
              block.move.BoundRate(block.u, {1, -1});
            }),
            "block: phase 'move': the rate of 'force': contradictory bounds [1, -1]");
  block.move.BoundRate(block.u, {-1, 1});
  EXPECT_EQ(MessageOf([&] {
              block.move.BoundRate(block.u, {2, 3});
            }),
            "block: phase 'move': the rate of 'force': contradictory bounds [2, 1]");
  EXPECT_EQ(MessageOf([&] {
              block.problem.Continue({block.u, At::kEnd}, {block.x, At::kStart});
            }),
            "block: move: force and move: x do not continue: only coordinates below the highest "
            "order do, and controls as controls");
}

}  // namespace
}  // namespace possibility::collocation
