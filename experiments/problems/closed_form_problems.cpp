// Problems with a closed-form answer (or one by quadrature of a closed form).
#include "experiments/problems/closed_form_problems.h"

#include <cmath>

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

ProblemPtr BlockMove() {
  auto problem = std::make_unique<OptimalControlProblem>("block move");
  Phase& phase = problem->AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("force");
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.Fix(phase.Rate(x), 0, At::kStart);
  phase.Fix(phase.Rate(x), 0, At::kEnd);
  phase.AddIntegralCost(
      "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  return problem;
}

ProblemPtr SlidingMass() {
  auto problem = std::make_unique<OptimalControlProblem>("sliding mass");
  Phase& phase = problem->AddPhase("slide", 2);
  const Variable x = phase.AddCoordinate("x", {0, 1});
  const Variable force = phase.AddControl("force", {-50, 50}, 50);
  phase.SetScale(phase.Rate(x), 5);
  phase.SetScale(phase.Rate(x, 2), 25);
  phase.SetDuration({0.01, 5});
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0] / 2.0; }),
                    {force});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.Fix(phase.Rate(x), 0, At::kStart);
  phase.Fix(phase.Rate(x), 0, At::kEnd);
  phase.Guess(phase.duration(), 1);
  problem->AddCost({phase.duration(), At::kEnd});
  return problem;
}

ProblemPtr Brachistochrone() {
  auto problem = std::make_unique<OptimalControlProblem>("brachistochrone");
  Phase& phase = problem->AddPhase("slide");
  const Variable x = phase.AddCoordinate("x", {0, 10}, 10);
  const Variable y = phase.AddCoordinate("y", {0, 10}, 10);
  const Variable v = phase.AddCoordinate("v", {0, 50}, 10);
  const Variable angle = phase.AddControl("angle", {0.01, 3.1});
  phase.SetDuration({0.5, 10});
  phase.SetDynamics(Differentiated<2, 3>([](const auto& z, auto* f) {
                      (*f)[0] = z[0] * sin(z[1]);
                      (*f)[1] = -(z[0] * cos(z[1]));
                      (*f)[2] = 9.80665 * cos(z[1]);
                    }),
                    {v, angle});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(y, 10, At::kStart);
  phase.Fix(v, 0, At::kStart);
  phase.Fix(x, 10, At::kEnd);
  phase.Fix(y, 5, At::kEnd);
  phase.Guess(v, [](double s) { return 9.9 * s; });
  phase.Guess(angle, [](double s) { return 0.1 + 1.6 * s; });
  phase.Guess(phase.duration(), 2);
  problem->AddCost({phase.duration(), At::kEnd});
  return problem;
}

ProblemPtr LinearTangentSteering() {
  auto problem = std::make_unique<OptimalControlProblem>("linear tangent steering");
  Phase& phase = problem->AddPhase("ascent", 2);
  const Variable x = phase.AddCoordinate("x", {}, 10);
  const Variable y = phase.AddCoordinate("y", {}, 5);
  phase.SetScale(phase.Rate(x), 45);
  phase.SetScale(phase.Rate(y), 10);
  phase.SetScale(phase.Rate(x, 2), 100);
  phase.SetScale(phase.Rate(y, 2), 100);
  const Variable angle = phase.AddControl("angle", {-1.57, 1.57});
  phase.SetDuration({0.1, 2});
  phase.SetDynamics(Differentiated<1, 2>([](const auto& z, auto* a) {
                      (*a)[0] = 100.0 * cos(z[0]);
                      (*a)[1] = 100.0 * sin(z[0]);
                    }),
                    {angle});
  for (const Variable& start : {x, y, phase.Rate(x), phase.Rate(y)}) {
    phase.Fix(start, 0, At::kStart);
  }
  phase.Fix(y, 5, At::kEnd);
  phase.Fix(phase.Rate(x), 45, At::kEnd);
  phase.Fix(phase.Rate(y), 0, At::kEnd);
  phase.Guess(phase.duration(), 0.7);
  phase.Guess(angle, [](double s) { return 1 - 2 * s; });
  problem->AddCost({phase.duration(), At::kEnd});
  return problem;
}

ProblemPtr LinearHypersensitive() {
  auto problem = std::make_unique<OptimalControlProblem>("linear hypersensitive");
  Phase& phase = problem->AddPhase("decay");
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u");
  phase.SetDuration(10);
  phase.SetDynamics(Differentiated<2, 1>([](const auto& z, auto* f) { (*f)[0] = z[1] - z[0]; }),
                    {x, u});
  phase.Fix(x, 1.5, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.AddIntegralCost("squares", Differentiated<2, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * z[0] + z[1] * z[1];
                        }),
                        {x, u}, 0.5);
  return problem;
}

/// Kirk 1970, example 5.1-1.
ProblemPtr Kirk() {
  auto problem = std::make_unique<OptimalControlProblem>("Kirk 5.1-1");
  Phase& phase = problem->AddPhase("drive");
  const Variable x = phase.AddCoordinate("x", {}, 5);
  const Variable v = phase.AddCoordinate("v", {}, 5);
  const Variable u = phase.AddControl("u", {}, 5);
  phase.SetDuration(2);
  phase.SetDynamics(Differentiated<2, 2>([](const auto& z, auto* f) {
                      (*f)[0] = z[0];
                      (*f)[1] = z[1] - z[0];
                    }),
                    {v, u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(v, 0, At::kStart);
  phase.Fix(x, 5, At::kEnd);
  phase.Fix(v, 2, At::kEnd);
  phase.AddIntegralCost("effort",
                        Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }),
                        {u}, 0.5);
  return problem;
}

ProblemPtr BrysonDenham() {
  auto problem = std::make_unique<OptimalControlProblem>("Bryson-Denham");
  Phase& phase = problem->AddPhase("bounce", 2);
  const Variable x = phase.AddCoordinate("x", {-kInfinity, 1.0 / 9});
  const Variable u = phase.AddControl("u");
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 0, At::kEnd);
  phase.Fix(phase.Rate(x), 1, At::kStart);
  phase.Fix(phase.Rate(x), -1, At::kEnd);
  phase.AddIntegralCost("effort",
                        Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }),
                        {u}, 0.5);
  return problem;
}

/// A chain of length 4 between (0, 1) and (1, 3) with the lowest centre of mass.
ProblemPtr HangingChain() {
  auto problem = std::make_unique<OptimalControlProblem>("hanging chain");
  Phase& phase = problem->AddPhase("chain");
  const Variable x = phase.AddCoordinate("height");
  const Variable length = phase.AddCoordinate("length", {}, 4);
  const Variable u = phase.AddControl("slope", {-20, 20}, 5);
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 2>([](const auto& z, auto* f) {
                      (*f)[0] = z[0];
                      (*f)[1] = sqrt(1.0 + z[0] * z[0]);
                    }),
                    {u});
  phase.Fix(x, 1, At::kStart);
  phase.Fix(x, 3, At::kEnd);
  phase.Fix(length, 0, At::kStart);
  phase.Fix(length, 4, At::kEnd);
  phase.Guess(x, [](double s) { return 1 - 6 * s + 8 * s * s; });
  phase.Guess(u, [](double s) { return -6 + 16 * s; });
  phase.AddIntegralCost("potential", Differentiated<2, 1>([](const auto& z, auto* c) {
                          (*c)[0] = z[0] * sqrt(1.0 + z[1] * z[1]);
                        }),
                        {x, u});
  return problem;
}

/// A mass with a leg of stroke 0.3 m and force 0 to 3 m g; apex after push-off and flight.
ProblemPtr HopperProblem() {
  constexpr double kGravity = 9.80665;
  auto problem = std::make_unique<OptimalControlProblem>("hopper");
  Phase& push = problem->AddPhase("push", 2);
  const Variable y = push.AddCoordinate("y", {0, 0.3});
  const Variable force = push.AddControl("force", {0, 3 * kGravity}, 3 * kGravity);
  push.SetScale(push.Rate(y), 3);
  push.Bound(push.Rate(y), {0, kInfinity});  // the leg only extends
  push.SetScale(push.Rate(y, 2), 20);
  push.SetDuration({0.02, 1});
  push.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0] - kGravity; }),
                   {force});
  push.Fix(y, 0, At::kStart);
  push.Fix(push.Rate(y), 0, At::kStart);
  push.Guess(push.duration(), 0.3);
  Phase& rise = problem->AddPhase("rise", 2);
  const Variable h = rise.AddCoordinate("h");
  rise.SetScale(rise.Rate(h), 3);
  rise.SetScale(rise.Rate(h, 2), 10);
  rise.SetDuration({0.02, 2});
  rise.SetDynamics(Differentiated<1, 1>([](const auto&, auto* a) { (*a)[0] = -kGravity; }), {h});
  rise.Fix(rise.Rate(h), 0, At::kEnd);
  rise.Guess(rise.duration(), 0.3);
  push.Fix(y, 0.3, At::kEnd);
  problem->Continue({y, At::kEnd}, {h, At::kStart});
  problem->Continue({push.Rate(y), At::kEnd}, {rise.Rate(h), At::kStart});
  problem->AddCost({h, At::kEnd}, -1);
  return problem;
}

}  // namespace

std::vector<RegressionProblem> ClosedFormProblems() {
  constexpr double kClosedForm = 1e-6;
  const auto exactly = [](double value) {
    return std::vector<KnownOptimum>{{"global", value, kClosedForm}};
  };
  return {
      {"block_move", "closed form 12 d^2/T^3", exactly(12), &BlockMove, 20},
      {"sliding_mass", "closed form 2 sqrt(d m/F), bang-bang", exactly(0.4), &SlidingMass, 20},
      {"brachistochrone", "closed form (cycloid), g = 9.80665, (0, 10) to (10, 5)",
       exactly(1.80160312245308), &Brachistochrone, 40, 1e-6},
      {"linear_tangent_steering", "Bryson & Ho 1975, section 2.4; Betts 2010: 0.554570879",
       exactly(0.554570878334603), &LinearTangentSteering, 30},
      {"linear_hypersensitive", "closed form", exactly(1.67309397841219), &LinearHypersensitive, 40,
       1e-7},
      {"kirk", "Kirk 1970, example 5.1-1, closed form", exactly(16.7507233967963), &Kirk, 40},
      {"bryson_denham", "Bryson & Denham 1963; closed form 4/(9 l) with l = 1/9", exactly(4),
       &BrysonDenham, 30},
      {"hanging_chain", "closed form (catenary of length 4)", exactly(5.06848011099342),
       &HangingChain, 40, 1e-7},
      {"hopper", "closed form: apex s (F/(m g) - 1) above take-off at s = 0.3", exactly(-0.9),
       &HopperProblem, 10, 0, Trapezoidal()},
  };
}

}  // namespace possibility::experiments
