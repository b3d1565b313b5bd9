// Problems whose controls jump between their bounds or are singular: least time, least fuel.
#include "experiments/problems/time_optimal_problems.h"

#include <array>
#include <cmath>
#include <numbers>

#include "experiments/problems/problem_parts.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// x'' = u between -2 and 1, from rest to rest, 300 in the least time.
ProblemPtr BangBang() {
  auto problem = std::make_unique<OptimalControlProblem>("bang-bang");
  Phase& phase = problem->AddPhase("drive", 2);
  const Variable x = phase.AddCoordinate("x", {}, 300);
  const Variable u = phase.AddControl("u", {-2, 1});
  phase.SetScale(phase.Rate(x), 20);
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  FixAll(phase, At::kStart, {{x, 0}, {phase.Rate(x), 0}});
  FixAll(phase, At::kEnd, {{x, 300}, {phase.Rate(x), 0}});
  MinimiseDuration(*problem, phase, {1, 100});
  return problem;
}

/// x'' = u - x with |u| <= 1, from rest at 1 to rest at 0 in the least time.
ProblemPtr Oscillator() {
  auto problem = std::make_unique<OptimalControlProblem>("oscillator");
  Phase& phase = problem->AddPhase("stop", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-1, 1});
  phase.SetDynamics(FunctionOf([](auto y, auto force) { return force - y; }), {x, u});
  FixAll(phase, At::kStart, {{x, 1}, {phase.Rate(x), 0}});
  FixAll(phase, At::kEnd, {{x, 0}, {phase.Rate(x), 0}});
  MinimiseDuration(*problem, phase, {0.1, 5});
  return problem;
}

/// x'' = push - pull, both from 0 to 1, from rest to rest, 1 in 3 s with the least fuel.
ProblemPtr LeastFuel() {
  auto problem = std::make_unique<OptimalControlProblem>("least fuel");
  Phase& phase = problem->AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable push = phase.AddControl("push", {0, 1});
  const Variable pull = phase.AddControl("pull", {0, 1});
  phase.SetDuration(3);
  phase.SetDynamics(FunctionOf([](auto p, auto q) { return p - q; }), {push, pull});
  FixAll(phase, At::kStart, {{x, 0}, {phase.Rate(x), 0}});
  FixAll(phase, At::kEnd, {{x, 1}, {phase.Rate(x), 0}});
  phase.AddIntegralCost("fuel", FunctionOf([](auto p, auto q) { return p + q; }), {push, pull});
  return problem;
}

/// x'' = u with |u| <= 1 from 2 to 5, from rest to rest: half the integral of 1 + x'^2.
ProblemPtr SingularCruise() {
  auto problem = std::make_unique<OptimalControlProblem>("singular cruise");
  Phase& phase = problem->AddPhase("drive", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-1, 1});
  phase.SetDuration({2, 8});
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  FixAll(phase, At::kStart, {{x, 2}, {phase.Rate(x), 0}});
  FixAll(phase, At::kEnd, {{x, 5}, {phase.Rate(x), 0}});
  phase.AddIntegralCost("cost", FunctionOf([](auto v) { return 1.0 + v * v; }), {phase.Rate(x)},
                        0.5);
  return problem;
}

/// x'' = u with |u| <= 1 from (0, 1) to (0, 0) with the least integral of x^2: infinitely many
/// switches.
ProblemPtr Fuller() {
  auto problem = std::make_unique<OptimalControlProblem>("Fuller");
  Phase& phase = problem->AddPhase("stop", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-1, 1});
  phase.SetDuration(3.5);
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  FixAll(phase, At::kStart, {{x, 0}, {phase.Rate(x), 1}});
  FixAll(phase, At::kEnd, {{x, 0}, {phase.Rate(x), 0}});
  phase.AddIntegralCost("square", FunctionOf([](auto y) { return y * y; }), {x});
  return problem;
}

/// x'' = u with |u| <= 1 from (0, 1) in 5 s: half the integral of x^2 + x'^2, singular at last.
ProblemPtr SingularRegulator() {
  auto problem = std::make_unique<OptimalControlProblem>("singular regulator");
  Phase& phase = problem->AddPhase("settle", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-1, 1});
  phase.SetDuration(5);
  phase.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  FixAll(phase, At::kStart, {{x, 0}, {phase.Rate(x), 1}});
  phase.AddIntegralCost("squares", FunctionOf([](auto y, auto v) { return y * y + v * v; }),
                        {x, phase.Rate(x)}, 0.5);
  return problem;
}

/// Two equal rods in a plane, torques within 1, from (0.5, 0) to (0.5, 0.522) in the least time:
/// Luus's two-link arm. x1, x2: angular velocities; x3: elbow; x4: shoulder.
ProblemPtr TwoLinkArm() {
  auto problem = std::make_unique<OptimalControlProblem>("two-link arm");
  Phase& phase = problem->AddPhase("swing");
  const Variable x1 = phase.AddCoordinate("x1");
  const Variable x2 = phase.AddCoordinate("x2");
  const Variable x3 = phase.AddCoordinate("x3");
  const Variable x4 = phase.AddCoordinate("x4");
  const Variable u1 = phase.AddControl("u1", {-1, 1});
  const Variable u2 = phase.AddControl("u2", {-1, 1});
  phase.SetDynamics(
      FunctionOf([](auto w1, auto w2, auto q, auto t1, auto t2) {
        const auto s = sin(q), c = cos(q);
        const auto d = 31.0 / 36 + 2.25 * s * s;
        const auto t12 = t1 - t2;
        const auto a1 = s * (2.25 * c * w1 * w1 + 2.0 * w2 * w2) + t12 / 0.75 - 1.5 * c * t2;
        const auto a2 = t2 / (3.0 / 7) - 1.5 * c * t12 - s * (3.5 * w1 * w1 + 2.25 * c * w2 * w2);
        return std::array{a1 / d, a2 / d, w2 - w1, w1};
      }),
      {x1, x2, x3, u1, u2});
  FixAll(phase, At::kStart, {{x1, 0}, {x2, 0}, {x3, 0.5}, {x4, 0}});
  FixAll(phase, At::kEnd, {{x1, 0}, {x2, 0}, {x3, 0.5}, {x4, 0.522}});
  MinimiseDuration(*problem, phase, {1, 10});
  return problem;
}

/// A telescopic arm of length 5 that turns by 120 degrees and returns to its reach and height.
ProblemPtr RobotArm() {
  auto problem = std::make_unique<OptimalControlProblem>("robot arm");
  Phase& phase = problem->AddPhase("turn", 2);
  const Variable reach = phase.AddCoordinate("reach", {0, 5});
  const Variable heading = phase.AddCoordinate("heading", {-std::numbers::pi, std::numbers::pi});
  const Variable height = phase.AddCoordinate("height", {0, std::numbers::pi});
  const Variable u1 = phase.AddControl("u1", {-1, 1});
  const Variable u2 = phase.AddControl("u2", {-1, 1});
  const Variable u3 = phase.AddControl("u3", {-1, 1});
  phase.SetDynamics(FunctionOf([](auto r, auto q, auto f1, auto f2, auto f3) {
                      const auto s = sin(q), o = 5.0 - r;
                      const auto inertia = (o * o * o + r * r * r) / 3.0;
                      return std::array{0.2 * f1, f2 / (inertia * s * s), f3 / inertia};
                    }),
                    {reach, height, u1, u2, u3});
  FixAll(phase, At::kStart, {{reach, 4.5}, {heading, 0}, {height, std::numbers::pi / 4}});
  FixAll(phase, At::kEnd,
         {{reach, 4.5}, {heading, 2 * std::numbers::pi / 3}, {height, std::numbers::pi / 4}});
  for (const At end : {At::kStart, At::kEnd}) {
    for (const Variable& q : {reach, heading, height}) phase.Fix(phase.Rate(q), 0, end);
  }
  MinimiseDuration(*problem, phase, {1, 20});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> TimeOptimalProblems() {
  constexpr double kJump = 1e-5;  // of the control, between two knots
  const auto scheme = Trapezoidal();
  return {
      {"bang_bang", "closed form, two arcs of 20 and 10 s: 30", OneOptimum(30, kJump), &BangBang,
       300, 0, scheme},
      {"oscillator", "Pontryagin et al. 1962; closed form, two arcs: acos(7/8) + acos(1/4)",
       OneOptimum(1.823476581936975, kJump), &Oscillator, 400, 0, scheme},
      {"least_fuel", "closed form, thrust, coast, thrust: 3 - sqrt(5)",
       OneOptimum(0.7639320225002103, kJump), &LeastFuel, 800, 0, scheme},
      {"singular_cruise", "Locatelli 2017, problem 11.2-1; PSOPT singular_di: 3.333328; 10 / 3",
       OneOptimum(10.0 / 3, 1e-6), &SingularCruise, 200, 0, scheme},
      {"fuller", "Fuller 1960; closed form (geometric series of arcs)",
       OneOptimum(0.2683938305689113, kJump), &Fuller, 400, 0, scheme},
      {"singular_regulator", "Aly 1978; closed form: one arc, then x'' = x",
       OneOptimum(0.3769919302879446, kJump), &SingularRegulator, 1000, 0, scheme},
      // The switching times that meet the end exactly. PSOPT's number is 2.1e-3 above.
      {"two_link_arm",
       "PROPT manual, after Luus; switching times (PSOPT twolinkarm: 2.988662)",
       {{"global", 2.982279942550, kJump}, {"elbow the other way", 3.208345350674, kJump}},
       &TwoLinkArm,
       400,
       0,
       scheme},
      // The same. The published number is 5.1e-5 above.
      {"robot_arm", "COPS 3.0, robot; switching times (dymos robot_arm: 9.14138)",
       OneOptimum(9.140911745915, kJump), &RobotArm, 500, 0, scheme},
  };
}

}  // namespace possibility::experiments
