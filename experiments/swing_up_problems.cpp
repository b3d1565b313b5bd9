// Swing-ups: several extremals lie close to each other, each with a name.
#include <cmath>
#include <numbers>

#include "experiments/regression_problems.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// Mass and length 1, no friction, from hanging to standing with the least integral of torque^2.
ProblemPtr PendulumSwingUp(double duration) {
  auto problem = std::make_unique<OptimalControlProblem>("pendulum swing-up");
  Phase& phase = problem->AddPhase("swing", 2);
  const Variable q = phase.AddCoordinate("angle", {}, 3);
  const Variable u = phase.AddControl("torque", {}, 5);
  phase.SetScale(phase.Rate(q), 5);
  phase.SetScale(phase.Rate(q, 2), 10);
  phase.SetDuration(duration);
  phase.SetDynamics(
      Differentiated<2, 1>([](const auto& z, auto* a) { (*a)[0] = z[1] - 9.81 * sin(z[0]); }),
      {q, u});
  phase.Fix(q, 0, At::kStart);
  phase.Fix(q, std::numbers::pi, At::kEnd);
  phase.Fix(phase.Rate(q), 0, At::kStart);
  phase.Fix(phase.Rate(q), 0, At::kEnd);
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

/// Kelly 2017, section 6: cart 1 kg, pole 0.3 kg at 0.5 m, 1 m in 2 s, force within 20 N.
ProblemPtr CartPole() {
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
                      (*a)[0] = (spin + z[2] + m2 * g * c * s) / (m1 + m2 * (1.0 - c * c));
                      (*a)[1] = -(c * spin + z[2] * c + (m1 + m2) * g * s) /
                                (l * m1 + l * m2 * (1.0 - c * c));
                    }),
                    {q, phase.Rate(q), u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(q, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.Fix(q, std::numbers::pi, At::kEnd);
  for (const At end : {At::kStart, At::kEnd}) {
    phase.Fix(phase.Rate(x), 0, end);
    phase.Fix(phase.Rate(q), 0, end);
  }
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> SwingUpProblems() {
  return {
      {"pendulum_1s",
       "indirect shooting",
       {{"global", 148.12331844, 1e-6}},
       [] { return PendulumSwingUp(1); },
       40},
      {"pendulum_2s",
       "indirect shooting",
       {{"global", 65.47690384, 1e-6}, {"second basin", 68.13, 1e-4}, {"third basin", 69.41, 1e-4}},
       [] { return PendulumSwingUp(2); },
       60},
      {"cart_pole",
       "Kelly 2017; Dymos pins the second basin's neighbour; indirect shooting",
       {{"global", 57.94478031, 1e-6},
        {"second basin", 58.80766746, 1e-6},
        {"third basin", 59.10826391, 1e-6}},
       &CartPole,
       60,
       1e-6},
  };
}

}  // namespace possibility::experiments
