// Problems of the calculus of variations: shortest, quickest, largest. All have closed forms.
#include "experiments/problems/variational_problems.h"

#include <array>
#include <cmath>
#include <numbers>

#include "experiments/problems/problem_parts.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;

/// The shortest way between two points of the unit sphere, latitude by longitude.
ProblemPtr GreatCircle() {
  auto problem = std::make_unique<OptimalControlProblem>("great circle");
  Phase& phase = problem->AddPhase("way");
  const Variable latitude = phase.AddCoordinate("latitude");
  const Variable slope = phase.AddControl("slope");
  phase.SetDuration(2);
  phase.SetDynamics(FunctionOf([](auto u) { return u; }), {slope});
  phase.Fix(latitude, 0.5, At::kStart);
  phase.Fix(latitude, 0.9, At::kEnd);
  const auto length = FunctionOf([](auto q, auto u) { return sqrt(u * u + cos(q) * cos(q)); });
  phase.AddIntegralCost("length", length, {latitude, slope});
  return problem;
}

/// The surface of revolution with the least area between two rings of radius 1, 1 apart.
ProblemPtr SoapFilm() {
  auto problem = std::make_unique<OptimalControlProblem>("soap film");
  Phase& phase = problem->AddPhase("film");
  const Variable radius = phase.AddCoordinate("radius", {0, 2});
  const Variable slope = phase.AddControl("slope");
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto u) { return u; }), {slope});
  phase.Fix(radius, 1, At::kStart);
  phase.Fix(radius, 1, At::kEnd);
  const auto area = FunctionOf([](auto r, auto u) { return r * sqrt(1.0 + u * u); });
  phase.AddIntegralCost("area", area, {radius, slope}, 2 * std::numbers::pi);
  return problem;
}

/// The greatest area between a line of length 1 and a curve of at most pi / 2 above it. The
/// direction is a vector: with an angle, knots where the curve turns back are local optima.
ProblemPtr Dido() {
  auto problem = std::make_unique<OptimalControlProblem>("Dido");
  Phase& phase = problem->AddPhase("curve");
  const Variable x = phase.AddCoordinate("x");
  const Variable y = phase.AddCoordinate("y");
  const Variable along = phase.AddControl("along");
  const Variable up = phase.AddControl("up");
  phase.SetDuration(std::numbers::pi / 2);
  phase.SetDynamics(FunctionOf([](auto a, auto b) { return std::array{a, b}; }), {along, up});
  phase.Constrain("length", FunctionOf([](auto a, auto b) { return a * a + b * b; }), {along, up},
                  {{0, 1}});
  FixAll(phase, At::kStart, {{x, 0}, {y, 0}});
  FixAll(phase, At::kEnd, {{x, 1}, {y, 0}});
  const auto area = FunctionOf([](auto height, auto a) { return height * a; });
  phase.AddIntegralCost("area", area, {y, along}, -1);
  return problem;
}

/// A medium that is crossed at constant speed: x' = v cos, y' = v sin of the angle.
Phase& AddMedium(OptimalControlProblem& problem, const char* name, double speed) {
  Phase& phase = problem.AddPhase(name);
  phase.AddCoordinate("x");
  phase.AddCoordinate("y");
  const Variable angle = phase.AddControl("angle", {0, std::numbers::pi / 2});
  phase.SetDynamics(FunctionOf([speed](auto q) {
                      return std::array{speed * cos(q), speed * sin(q)};
                    }),
                    {angle});
  MinimiseDuration(problem, phase, {0.1, 5});
  return phase;
}

/// From (0, 0) to (2, 2) in the least time, with speed 1 below y = 1 and 0.6 above.
ProblemPtr Refraction() {
  auto problem = std::make_unique<OptimalControlProblem>("refraction");
  Phase& fast = AddMedium(*problem, "fast", 1);
  Phase& slow = AddMedium(*problem, "slow", 0.6);
  const Variable x1 = fast.Coordinate(0), y1 = fast.Coordinate(1);
  const Variable x2 = slow.Coordinate(0), y2 = slow.Coordinate(1);
  FixAll(fast, At::kStart, {{x1, 0}, {y1, 0}});
  fast.Fix(y1, 1, At::kEnd);
  slow.Fix(y2, 1, At::kStart);
  FixAll(slow, At::kEnd, {{x2, 2}, {y2, 2}});
  problem->Continue({x1, At::kEnd}, {x2, At::kStart});
  return problem;
}

/// The quickest slide, from rest, to a wall 2 m away.
ProblemPtr SlideToAWall() {
  auto problem = std::make_unique<OptimalControlProblem>("slide to a wall");
  Phase& phase = problem->AddPhase("slide");
  const Variable x = phase.AddCoordinate("x");
  const Variable v = phase.AddCoordinate("v", {0, 20}, 5);
  const Variable angle = phase.AddControl("angle", {0, std::numbers::pi / 2});
  phase.SetDynamics(FunctionOf([](auto speed, auto q) {
                      return std::array{speed * cos(q), 9.80665 * sin(q)};
                    }),
                    {v, angle});
  FixAll(phase, At::kStart, {{x, 0}, {v, 0}});
  phase.Fix(x, 2, At::kEnd);
  phase.Guess(angle, std::numbers::pi / 4);
  MinimiseDuration(*problem, phase, {0.1, 3});
  return problem;
}

/// A ship of speed 1 in a current of -y along x, from (3.66, -1.86) to (0, 0).
ProblemPtr Zermelo() {
  auto problem = std::make_unique<OptimalControlProblem>("Zermelo");
  Phase& phase = problem->AddPhase("crossing");
  const Variable x = phase.AddCoordinate("x", {}, 4);
  const Variable y = phase.AddCoordinate("y", {}, 2);
  const Variable heading = phase.AddControl("heading", {0, 2 * std::numbers::pi});
  phase.SetDynamics(FunctionOf([](auto h, auto q) {
                      return std::array{cos(q) - h, sin(q)};
                    }),
                    {y, heading});
  FixAll(phase, At::kStart, {{x, 3.66}, {y, -1.86}});
  FixAll(phase, At::kEnd, {{x, 0}, {y, 0}});
  phase.Guess(heading, std::numbers::pi);
  MinimiseDuration(*problem, phase, {1, 10});
  return problem;
}

/// The shortest way from (0, 0) to (2, 0) round a disc of radius 0.5 at (1, -0.2).
ProblemPtr RoundADisc() {
  auto problem = std::make_unique<OptimalControlProblem>("round a disc");
  Phase& phase = problem->AddPhase("way");
  const Variable x = phase.AddCoordinate("x");
  const Variable y = phase.AddCoordinate("y");
  const Variable angle = phase.AddControl("angle", {-3, 3});
  phase.SetDynamics(FunctionOf([](auto q) { return std::array{cos(q), sin(q)}; }), {angle});
  FixAll(phase, At::kStart, {{x, 0}, {y, 0}});
  FixAll(phase, At::kEnd, {{x, 2}, {y, 0}});
  const auto distance2 = FunctionOf(
      [](auto px, auto py) { return (px - 1.0) * (px - 1.0) + (py + 0.2) * (py + 0.2); });
  phase.Constrain("disc", distance2, {x, y}, {{0.25, kInfinity}});
  MinimiseDuration(*problem, phase, {0.5, 10});
  return problem;
}

}  // namespace

std::vector<RegressionProblem> VariationalProblems() {
  constexpr double kClosedForm = 1e-6;
  return {
      {"great_circle", "closed form (spherical law of cosines)",
       OneOptimum(1.421711703810593, kClosedForm), &GreatCircle, 40},
      {"soap_film", "closed form (Euler 1744: catenoid c cosh(z / c), the wide one)",
       OneOptimum(5.991796975802282, kClosedForm), &SoapFilm, 20},
      {"dido", "closed form (half a circle): pi / 8", OneOptimum(-0.3926990816987242, kClosedForm),
       &Dido, 30},
      {"refraction", "closed form (Snell's law)", OneOptimum(3.663355910798977, kClosedForm),
       &Refraction, 10},
      {"slide_to_a_wall", "closed form (half a cycloid): sqrt(pi d / g)",
       OneOptimum(0.8004414986040972, kClosedForm), &SlideToAWall, 40, 1e-6},
      {"zermelo", "Bryson & Ho 1975, section 2.7: 5.46; closed form (linear law of the tangent)",
       OneOptimum(5.457865263560509, kClosedForm), &Zermelo, 40},
      {"round_a_disc", "closed form (two tangents and an arc)", OneOptimum(2.092666169998844, 2e-6),
       &RoundADisc, 400, 0, Trapezoidal()},
  };
}

}  // namespace possibility::experiments
