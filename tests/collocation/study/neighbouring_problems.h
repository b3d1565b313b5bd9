#pragma once

#include <memory>
#include <numbers>

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::collocation {

/// Families of problems of the same structure that differ by one number.

/// 1 kg is moved from rest to rest in 1 s with the least integral of force^2. The integral is 12
/// distance^2 where the force's bound is not active.
inline std::unique_ptr<OptimalControlProblem> BlockMove(double distance, double strongest = 100) {
  auto problem = std::make_unique<OptimalControlProblem>("block move");
  Phase& phase = problem->AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("force", {-strongest, strongest});
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, distance, At::kEnd);
  phase.Fix(phase.Rate(x), 0, At::kStart);
  phase.Fix(phase.Rate(x), 0, At::kEnd);
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

/// The Goddard rocket in the units of COPS 3 (Dolan, More & Munson 2004): the greatest height until
/// `final_mass` is left.
inline std::unique_ptr<OptimalControlProblem> Goddard(double final_mass) {
  auto problem = std::make_unique<OptimalControlProblem>("Goddard rocket");
  Phase& phase = problem->AddPhase("ascent");
  const Variable h = phase.AddCoordinate("height", {1, 2});
  const Variable v = phase.AddCoordinate("speed", {0, 1}, 0.1);
  const Variable m = phase.AddCoordinate("mass", {0.5, 1});
  const Variable thrust = phase.AddControl("thrust", {0, 3.5});
  phase.SetDuration({0.05, 1});
  phase.SetDynamics(Differentiated<4, 3>([](const auto& z, auto* f) {
                      const auto drag = 310.0 * z[1] * z[1] * exp(500.0 * (1.0 - z[0]));
                      (*f)[0] = z[1];
                      (*f)[1] = (z[3] - drag) / z[2] - 1.0 / (z[0] * z[0]);
                      (*f)[2] = -2.0 * z[3];
                    }),
                    {h, v, m, thrust});
  phase.Fix(h, 1, At::kStart);
  phase.Fix(v, 0, At::kStart);
  phase.Fix(m, 1, At::kStart);
  phase.Fix(m, final_mass, At::kEnd);
  phase.Guess(h, 1);
  phase.Guess(v, [](double s) { return s * (1 - s); });
  phase.Guess(m, [](double s) { return 1 - 0.4 * s; });
  phase.Guess(thrust, 1.75);
  phase.Guess(phase.duration(), 0.2);
  problem->AddCost({h, At::kEnd}, -1);
  return problem;
}

/// Kelly 2017, section 6: swing-up. The cart's end is `distance` from its start.
inline std::unique_ptr<OptimalControlProblem> CartPole(double distance) {
  auto problem = std::make_unique<OptimalControlProblem>("cart-pole swing-up");
  Phase& phase = problem->AddPhase("swing", 2);
  const Variable x = phase.AddCoordinate("cart", {-2, 2});
  const Variable q = phase.AddCoordinate("pole", {}, 3);
  const Variable u = phase.AddControl("force", {-20, 20}, 10);
  phase.SetScale(phase.Rate(x), 3);
  phase.SetScale(phase.Rate(q), 5);
  phase.SetScale(phase.Rate(x, 2), 10);
  phase.SetScale(phase.Rate(q, 2), 30);
  phase.SetDuration(2);
  phase.SetDynamics(Differentiated<3, 2>([](const auto& z, auto* a) {
                      const double m1 = 1, m2 = 0.3, l = 0.5, g = 9.81;
                      const auto s = sin(z[0]);
                      const auto c = cos(z[0]);
                      const auto spin = l * m2 * s * z[1] * z[1];
                      const auto mass = m1 + m2 * (1.0 - c * c);
                      (*a)[0] = (spin + z[2] + m2 * g * c * s) / mass;
                      (*a)[1] = -(c * spin + z[2] * c + (m1 + m2) * g * s) / (l * mass);
                    }),
                    {q, phase.Rate(q), u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(q, 0, At::kStart);
  phase.Fix(x, distance, At::kEnd);
  phase.Fix(q, std::numbers::pi, At::kEnd);
  for (const At end : {At::kStart, At::kEnd}) {
    phase.Fix(phase.Rate(x), 0, end);
    phase.Fix(phase.Rate(q), 0, end);
  }
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

/// Two phases of free duration that share a state, a parameter and a bounded control. The objective
/// is the shortest time to x = `distance`, with a speed of at most `speed` in the first phase.
inline std::unique_ptr<OptimalControlProblem> TwoLegs(double distance, double speed) {
  auto problem = std::make_unique<OptimalControlProblem>("two legs");
  const Variable drag = problem->AddParameter("drag", {0.1, 2}, 1, 1);
  Variable x_before, v_before;
  for (const char* name : {"fast", "slow"}) {
    Phase& phase = problem->AddPhase(name, 2);
    const Variable x = phase.AddCoordinate("x", {-1, 20}, 5);
    const Variable u = phase.AddControl("force", {-3, 3});
    phase.SetDuration({0.2, 10});
    phase.SetDynamics(
        Differentiated<3, 1>([](const auto& z, auto* a) { (*a)[0] = z[0] - z[1] * z[2] * z[2]; }),
        {u, drag, phase.Rate(x)});
    phase.AddIntegralCost(
        "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u},
        0.1);
    problem->AddCost({phase.duration(), At::kEnd});
    if (problem->num_phases() == 1) {
      phase.Bound(phase.Rate(x), {0, speed});
      phase.Fix(x, 0, At::kStart);
      phase.Fix(phase.Rate(x), 0, At::kStart);
    } else {
      phase.Fix(x, distance, At::kEnd);
      phase.Fix(phase.Rate(x), 0, At::kEnd);
      problem->Continue({x_before, At::kEnd}, {x, At::kStart});
      problem->Continue({v_before, At::kEnd}, {phase.Rate(x), At::kStart});
    }
    x_before = x;
    v_before = phase.Rate(x);
  }
  problem->AddCost("drag", Differentiated<1, 1>([](const auto& z, auto* c) {
                     (*c)[0] = (z[0] - 0.5) * (z[0] - 0.5);
                   }),
                   {{drag, At::kStart}});
  return problem;
}

}  // namespace possibility::collocation
