// Problems from textbooks and test collections whose optimum is published as a number.
#include "experiments/problems/textbook_problems.h"

#include <cmath>

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// x' = -x^3 + u from 1 to 1.5 over a practically infinite time.
ProblemPtr Hypersensitive() {
  auto problem = std::make_unique<OptimalControlProblem>("hypersensitive");
  Phase& phase = problem->AddPhase("wait");
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u");
  phase.SetDuration(10000);
  phase.SetDynamics(
      Differentiated<2, 1>([](const auto& z, auto* f) { (*f)[0] = z[1] - z[0] * z[0] * z[0]; }),
      {x, u});
  phase.Fix(x, 1, At::kStart);
  phase.Fix(x, 1.5, At::kEnd);
  phase.AddIntegralCost("squares", Differentiated<2, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * z[0] + z[1] * z[1];
                        }),
                        {x, u});
  return problem;
}

/// COPS 3: the Goddard rocket, lengths, masses and speeds in units of their first values.
ProblemPtr Goddard() {
  auto problem = std::make_unique<OptimalControlProblem>("Goddard rocket");
  Phase& phase = problem->AddPhase("ascent");
  const Variable h = phase.AddCoordinate("height", {1, 2});
  const Variable v = phase.AddCoordinate("speed", {0, 1}, 0.1);
  const Variable m = phase.AddCoordinate("mass", {0.6, 1});
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
  phase.Fix(m, 0.6, At::kEnd);
  phase.Guess(h, 1);
  phase.Guess(v, [](double s) { return s * (1 - s); });
  phase.Guess(m, [](double s) { return 1 - 0.4 * s; });
  phase.Guess(thrust, 1.75);
  phase.Guess(phase.duration(), 0.2);
  problem->AddCost({h, At::kEnd}, -1);
  return problem;
}

/// Two catalysts mixed along a reactor (COPS 3; PSOPT "catmix").
ProblemPtr CatalystMixing() {
  auto problem = std::make_unique<OptimalControlProblem>("catalyst mixing");
  Phase& phase = problem->AddPhase("reactor");
  const Variable x1 = phase.AddCoordinate("x1", {0, 1});
  const Variable x2 = phase.AddCoordinate("x2", {0, 1});
  const Variable u = phase.AddControl("mix", {0, 1});
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<3, 2>([](const auto& z, auto* f) {
                      const auto first = z[2] * (10.0 * z[1] - z[0]);
                      (*f)[0] = first;
                      (*f)[1] = -first - (1.0 - z[2]) * z[1];
                    }),
                    {x1, x2, u});
  phase.Fix(x1, 1, At::kStart);
  phase.Fix(x2, 0, At::kStart);
  phase.Guess(x1, 1);
  phase.Guess(u, 0.3);
  problem->AddCost(
      "loss", Differentiated<2, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] + z[1] - 1.0; }),
      {{x1, At::kEnd}, {x2, At::kEnd}});
  return problem;
}

/// x'' = (1 - x^2) x' - x + u with a bounded u.
ProblemPtr VanDerPol() {
  auto problem = std::make_unique<OptimalControlProblem>("van der Pol");
  Phase& phase = problem->AddPhase("settle", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-0.3, 1});
  phase.SetDuration(5);
  phase.SetDynamics(Differentiated<3, 1>([](const auto& z, auto* a) {
                      (*a)[0] = (1.0 - z[0] * z[0]) * z[1] - z[0] + z[2];
                    }),
                    {x, phase.Rate(x), u});
  phase.Fix(x, 1, At::kStart);
  phase.Fix(phase.Rate(x), 0, At::kStart);
  phase.AddIntegralCost("squares", Differentiated<3, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * z[0] + z[1] * z[1] + z[2] * z[2];
                        }),
                        {x, phase.Rate(x), u});
  return problem;
}

/// The Rayleigh problem of an electric circuit, unconstrained.
ProblemPtr Rayleigh() {
  auto problem = std::make_unique<OptimalControlProblem>("Rayleigh");
  Phase& phase = problem->AddPhase("oscillate", 2);
  const Variable x = phase.AddCoordinate("current", {}, 5);
  const Variable u = phase.AddControl("voltage", {}, 2);
  phase.SetScale(phase.Rate(x), 5);
  phase.SetScale(phase.Rate(x, 2), 20);
  phase.SetDuration(2.5);
  phase.SetDynamics(Differentiated<3, 1>([](const auto& z, auto* a) {
                      (*a)[0] = -z[0] + z[1] * (1.4 - 0.14 * z[1] * z[1]) + 4.0 * z[2];
                    }),
                    {x, phase.Rate(x), u});
  phase.Fix(x, -5, At::kStart);
  phase.Fix(phase.Rate(x), -5, At::kStart);
  phase.AddIntegralCost("squares", Differentiated<2, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * z[0] + z[1] * z[1];
                        }),
                        {u, x});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> TextbookProblems() {
  const auto published = [](double value, double tolerance) {
    return std::vector<KnownOptimum>{{"global", value, tolerance}};
  };
  return {
      {"hypersensitive", "Betts 2010, problem 10.7: 6.7241; by quadrature 6.724113809886",
       published(6.724113809886, 2e-6), &Hypersensitive, 400, 1e-6},
      {"goddard", "COPS 3.0 (Dolan, More & Munson 2004), rocket: 1.01283",
       published(-1.01283, 1e-5), &Goddard, 200, 0, Trapezoidal()},
      // Singular in the middle: the objective converges slowly with the mesh. Half a unit of the
      // last published digit is 1.04e-6 of it.
      {"catalyst_mixing", "COPS 3.0, catmix: 4.80556e-2", published(-4.80556e-2, 1.04e-6),
       &CatalystMixing, 10000, 0, Trapezoidal()},
      // Pontryagin's conditions by single shooting (Runge-Kutta, 10,000 and 50,000 steps) give
      // 2.8672610452. The manual's number is 5e-7 below that, an effect of its mesh.
      {"van_der_pol", "Vassiliadis 1993; indirect shooting (PROPT manual: 2.867259538)",
       published(2.8672610452, 1e-7), &VanDerPol, 320},
      {"rayleigh", "PROPT manual, after Maurer & Augustin 2001: 29.376079656",
       published(29.376079656, 1e-8), &Rayleigh, 960},
  };
}

}  // namespace possibility::experiments
