// Swing-ups: several extremals lie close to each other, each with a name.
#include "experiments/problems/swing_up_problems.h"

#include <cmath>
#include <numbers>

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

/// Two rods of 1 kg and 1 m, a motor at the elbow alone, from hanging to standing in 4 s (the arm
/// of Spong 1995 with Tedrake's numbers: moments of inertia 1 kg m^2 about the joints).
ProblemPtr Acrobot() {
  auto problem = std::make_unique<OptimalControlProblem>("acrobot swing-up");
  Phase& phase = problem->AddPhase("swing", 2);
  const Variable shoulder = phase.AddCoordinate("shoulder", {}, 3);
  const Variable elbow = phase.AddCoordinate("elbow", {}, 3);
  const Variable u = phase.AddControl("torque", {-50, 50}, 10);
  for (const Variable& q : {shoulder, elbow}) {
    phase.SetScale(phase.Rate(q), 5);
    phase.SetScale(phase.Rate(q, 2), 20);
  }
  phase.SetDuration(4);
  phase.SetDynamics(Differentiated<5, 2>([](const auto& z, auto* a) {
                      const double g = 9.81;
                      const auto c = cos(z[1]);
                      const auto s = sin(z[1]);
                      const auto both = sin(z[0] + z[1]);
                      // M a + C + G = (0, u), the mass matrix inverted by hand.
                      const auto m11 = 3.0 + c;
                      const auto m12 = 1.0 + 0.5 * c;
                      const double m22 = 1;
                      const auto h1 = -0.5 * s * z[3] * (2.0 * z[2] + z[3]) +
                                      g * (1.5 * sin(z[0]) + 0.5 * both);
                      const auto h2 = 0.5 * s * z[2] * z[2] + 0.5 * g * both;
                      const auto determinant = m11 * m22 - m12 * m12;
                      const auto r2 = z[4] - h2;
                      (*a)[0] = (-(m22 * h1) - m12 * r2) / determinant;
                      (*a)[1] = (m12 * h1 + m11 * r2) / determinant;
                    }),
                    {shoulder, elbow, phase.Rate(shoulder), phase.Rate(elbow), u});
  phase.Fix(shoulder, 0, At::kStart);
  phase.Fix(elbow, 0, At::kStart);
  phase.Fix(shoulder, std::numbers::pi, At::kEnd);
  phase.Fix(elbow, 0, At::kEnd);
  for (const At end : {At::kStart, At::kEnd}) {
    phase.Fix(phase.Rate(shoulder), 0, end);
    phase.Fix(phase.Rate(elbow), 0, end);
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
      {"acrobot",
       "ours: both linear solvers, two meshes",
       {{"first", 121.6315, 1e-6}},
       &Acrobot,
       80,
       1e-6},
  };
}

}  // namespace possibility::experiments
