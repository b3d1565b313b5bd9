// Reactors and populations: systems of rate equations.
#include "experiments/problems/chemical_problems.h"

#include <array>
#include <cmath>

#include "experiments/problems/problem_parts.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// A -> B -> C in a batch: the temperature for the greatest yield of B after 1 h.
ProblemPtr BatchReactor() {
  auto problem = std::make_unique<OptimalControlProblem>("batch reactor");
  Phase& phase = problem->AddPhase("batch");
  const Variable a = phase.AddCoordinate("A", {0, 1});
  const Variable b = phase.AddCoordinate("B", {0, 1});
  const Variable temperature = phase.AddControl("temperature", {298, 398}, 100);
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto ca, auto cb, auto kelvin) {
                      const auto first = 4000.0 * exp(-2500.0 / kelvin) * ca * ca;
                      return std::array{-first, first - 620000.0 * exp(-5000.0 / kelvin) * cb};
                    }),
                    {a, b, temperature});
  FixAll(phase, At::kStart, {{a, 1}, {b, 0}});
  phase.Guess(temperature, 348);
  problem->AddCost({b, At::kEnd}, -1);
  return problem;
}

/// A -> B beside A -> C along a tube: the control for the greatest yield of B.
ProblemPtr ParallelReactions() {
  auto problem = std::make_unique<OptimalControlProblem>("parallel reactions");
  Phase& phase = problem->AddPhase("tube");
  const Variable a = phase.AddCoordinate("A", {0, 1});
  const Variable b = phase.AddCoordinate("B", {0, 1});
  const Variable u = phase.AddControl("u", {0, 5});
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto ca, auto k) {
                      return std::array{-((k + 0.5 * k * k) * ca), k * ca};
                    }),
                    {a, u});
  FixAll(phase, At::kStart, {{a, 1}, {b, 0}});
  phase.Guess(u, 2.5);
  problem->AddCost({b, At::kEnd}, -1);
  return problem;
}

/// Kirk 1970, section 6.2: a stirred tank returns to its steady state with little cooling.
ProblemPtr StirredTank() {
  auto problem = std::make_unique<OptimalControlProblem>("stirred tank");
  Phase& phase = problem->AddPhase("settle");
  const Variable x1 = phase.AddCoordinate("temperature", {}, 0.1);
  const Variable x2 = phase.AddCoordinate("concentration", {}, 0.1);
  const Variable u = phase.AddControl("cooling");
  phase.SetDuration(0.78);
  phase.SetDynamics(FunctionOf([](auto t, auto c, auto cooling) {
                      const auto rate = (c + 0.5) * exp(25.0 * t / (t + 2.0));
                      return std::array{rate - (2.0 + cooling) * (t + 0.25), 0.5 - c - rate};
                    }),
                    {x1, x2, u});
  FixAll(phase, At::kStart, {{x1, 0.05}, {x2, 0}});
  const auto squares = FunctionOf(
      [](auto t, auto c, auto cooling) { return t * t + c * c + 0.1 * cooling * cooling; });
  phase.AddIntegralCost("squares", squares, {x1, x2, u});
  return problem;
}

/// Sager 2005, the relaxed form: prey and predators near 1 by fishing both.
ProblemPtr Fishing() {
  auto problem = std::make_unique<OptimalControlProblem>("fishing");
  Phase& phase = problem->AddPhase("season");
  const Variable prey = phase.AddCoordinate("prey", {0, 5});
  const Variable predators = phase.AddCoordinate("predators", {0, 5});
  const Variable fishing = phase.AddControl("fishing", {0, 1});
  phase.SetDuration(12);
  phase.SetDynamics(FunctionOf([](auto x, auto y, auto w) {
                      return std::array{x - x * y - 0.4 * w * x, x * y - y - 0.2 * w * y};
                    }),
                    {prey, predators, fishing});
  FixAll(phase, At::kStart, {{prey, 0.5}, {predators, 0.7}});
  const auto deviation =
      FunctionOf([](auto x, auto y) { return (x - 1.0) * (x - 1.0) + (y - 1.0) * (y - 1.0); });
  phase.AddIntegralCost("deviation", deviation, {prey, predators});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> ChemicalProblems() {
  constexpr double kShooting = 1e-6;
  return {
      {"batch_reactor", "Ray 1981; Dadebo & McAuley 1995; indirect shooting",
       OneOptimum(-0.610802920554, kShooting), &BatchReactor, 60, 1e-6},
      {"parallel_reactions", "DYNOPT guide, problem 4; PROPT manual: 0.57354; indirect shooting",
       OneOptimum(-0.573545057539, kShooting), &ParallelReactions, 60},
      {"stirred_tank", "Kirk 1970, section 6.2: 0.02660; indirect shooting",
       OneOptimum(0.026603355460, kShooting), &StirredTank, 80},
      // Singular for most of the time. Half a unit of the last digit is 3.7e-6 of it.
      {"fishing", "Sager 2005, relaxed: 1.34408 (PSOPT lotka: 1.344093)",
       OneOptimum(1.34408, 3.7e-6), &Fishing, 800, 0, Trapezoidal()},
  };
}

}  // namespace possibility::experiments
