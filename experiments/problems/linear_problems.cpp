// Linear systems with quadratic costs. All have closed forms.
#include "experiments/problems/linear_problems.h"

#include <array>
#include <cmath>

#include "experiments/problems/problem_parts.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// x'' = u from x = 0 in 1 s, with the least half of the integral of u^2.
struct UnitMass {
  std::unique_ptr<OptimalControlProblem> problem;
  Phase* phase;
  Variable x, v;
};

UnitMass MakeUnitMass(const char* name, double speed, Bounds place = {}) {
  auto problem = std::make_unique<OptimalControlProblem>(name);
  Phase& phase = problem->AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x", place);
  const Variable u = phase.AddControl("u");
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  FixAll(phase, At::kStart, {{x, 0}, {phase.Rate(x), speed}});
  phase.AddIntegralCost("effort", FunctionOf([](auto force) { return force * force; }), {u}, 0.5);
  return {std::move(problem), &phase, x, phase.Rate(x)};
}

/// To x = 1 at any speed.
ProblemPtr FreeFinalSpeed() {
  UnitMass mass = MakeUnitMass("free final speed", 0);
  mass.phase->Fix(mass.x, 1, At::kEnd);
  return std::move(mass.problem);
}

/// To any state with x - 2 x' = 1.
ProblemPtr TargetLine() {
  UnitMass mass = MakeUnitMass("target line", 0);
  mass.problem->Link("line", FunctionOf([](auto x, auto v) { return x - 2.0 * v; }),
                     {{mass.x, At::kEnd}, {mass.v, At::kEnd}}, {{1, 1}});
  return std::move(mass.problem);
}

/// From speed 1 to -1 without passing the wall.
ProblemPtr BounceOffAWall(double wall) {
  UnitMass mass = MakeUnitMass("bounce", 1, {-kInfinity, wall});
  FixAll(*mass.phase, At::kEnd, {{mass.x, 0}, {mass.v, -1}});
  return std::move(mass.problem);
}

/// x' = x / 2 + u with a coupled cost.
ProblemPtr Hager() {
  auto problem = std::make_unique<OptimalControlProblem>("Hager");
  Phase& phase = problem->AddPhase("decay");
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u");
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto y, auto w) { return 0.5 * y + w; }), {x, u});
  phase.Fix(x, 1, At::kStart);
  const auto cost = FunctionOf([](auto y, auto w) { return 1.25 * y * y + y * w + w * w; });
  phase.AddIntegralCost("squares", cost, {x, u}, 0.5);
  return problem;
}

/// x' = u, integral of x^2 + u^2, from 1 through 0.9 at 0.75 s to 0.75 at 1 s.
ProblemPtr InteriorPoint() {
  auto problem = std::make_unique<OptimalControlProblem>("interior point");
  constexpr std::array<double, 3> kPlaces = {1, 0.9, 0.75};
  constexpr std::array<double, 2> kDurations = {0.75, 0.25};
  for (int i = 0; i < 2; ++i) {
    Phase& phase = problem->AddPhase(i == 0 ? "before" : "after");
    const Variable x = phase.AddCoordinate("x");
    const Variable u = phase.AddControl("u", {-1, 1});
    phase.SetDuration(kDurations[i]);
    phase.SetDynamics(FunctionOf([](auto w) { return w; }), {u});
    phase.Fix(x, kPlaces[i], At::kStart);
    phase.Fix(x, kPlaces[i + 1], At::kEnd);
    phase.AddIntegralCost("squares", FunctionOf([](auto y, auto w) { return y * y + w * w; }),
                          {x, u});
  }
  const Phase& before = problem->phase(0);
  const Phase& after = problem->phase(1);
  problem->Continue({before.Coordinate(0), At::kEnd}, {after.Coordinate(0), At::kStart});
  return problem;
}

/// x'' = u from rest to rest, 1 in 2 s. u starts at 0 and changes by at most 4 a second.
ProblemPtr LimitedRate() {
  auto problem = std::make_unique<OptimalControlProblem>("limited rate");
  Phase& phase = problem->AddPhase("move");
  const Variable x = phase.AddCoordinate("x");
  const Variable v = phase.AddCoordinate("v");
  const Variable u = phase.AddCoordinate("u");
  const Variable rate = phase.AddControl("rate", {-4, 4});
  phase.SetDuration(2);
  phase.SetDynamics(FunctionOf([](auto speed, auto force, auto jerk) {
                      return std::array{speed, force, jerk};
                    }),
                    {v, u, rate});
  FixAll(phase, At::kStart, {{x, 0}, {v, 0}, {u, 0}});
  FixAll(phase, At::kEnd, {{x, 1}, {v, 0}});
  phase.AddIntegralCost("effort", FunctionOf([](auto force) { return force * force; }), {u});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> LinearProblems() {
  constexpr double kClosedForm = 1e-6;
  constexpr double kJump = 1e-5;  // of the control, between two knots
  return {
      {"free_final_speed", "PSOPT mineng_free_vf: 1.500000; closed form 3 d^2 / (2 T^3)",
       OneOptimum(1.5, kClosedForm), &FreeFinalSpeed, 10},
      {"target_line", "Locatelli 2017, chapter 6; PSOPT mineng_target_set: 0.2142857; 3 / 14",
       OneOptimum(3.0 / 14, kClosedForm), &TargetLine, 10},
      {"breakwell", "PSOPT breakwell: 4.444439; closed form 4/(9 l) with l = 0.1",
       OneOptimum(40.0 / 9, kClosedForm), [] { return BounceOffAWall(0.1); }, 30},
      {"bounce_touch", "Bryson & Ho 1975, section 3.11: 2 + 6 (1 - 4 l)^2 with l = 0.2",
       OneOptimum(2.24, kClosedForm), [] { return BounceOffAWall(0.2); }, 30},
      {"hager", "Hager 1976; closed form tanh(1) / 2", OneOptimum(0.3807970779778824, kClosedForm),
       &Hager, 20},
      {"interior_point", "PSOPT interior_point: 0.9205314; closed form",
       OneOptimum(0.9205314414730029, kClosedForm), &InteriorPoint, 10},
      {"limited_rate", "PSOPT control_rate: 1.846315; closed form 24 / 13",
       OneOptimum(24.0 / 13, kJump), &LimitedRate, 1000, 0, Trapezoidal()},
  };
}

}  // namespace possibility::experiments
