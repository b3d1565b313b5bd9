#include "collocation/problem/unused_quantities.h"

#include <gtest/gtest.h>

#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

std::shared_ptr<Function> Square() {
  return Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = z[0] * z[0]; });
}

std::string UnusedIn(const OptimalControlProblem& problem) {
  return MessageOf([&] { CheckEverythingIsUsed(problem); });
}

/// A mass whose dynamics are not yet stated.
struct FreeMass {
  FreeMass() : phase(problem.AddPhase("lift", 2)) { q = phase.AddCoordinate("q", {-1, 1}); }

  OptimalControlProblem problem{"mass"};
  Phase& phase;
  Variable q;
};

constexpr char kForgotten[] =
    "mass: phase 'lift': no dynamics, constraint or cost contains the derivative of order 2 of 'q'";

TEST(UnusedQuantities, ForgottenDynamicsAreRefused) {
  FreeMass mass;
  EXPECT_EQ(UnusedIn(mass.problem), kForgotten);
  // None of these determines q'' between the ends.
  mass.phase.Fix(mass.q, 0, At::kStart);
  mass.phase.Fix(mass.phase.Rate(mass.q, 2), 0, At::kStart);
  mass.phase.Bound(mass.phase.Rate(mass.q), {-2, 2});
  mass.phase.AddIntegralCost("speed", Square(), {mass.phase.Rate(mass.q)});
  mass.phase.Constrain("tube", Square(), {mass.q}, {{0, 1}});
  EXPECT_EQ(UnusedIn(mass.problem), kForgotten);
}

TEST(UnusedQuantities, ACoordinateAddedAfterTheDynamicsIsRefused) {
  FreeMass mass;
  mass.phase.SetDynamics(Square(), {mass.q});
  EXPECT_EQ(UnusedIn(mass.problem), "no error");
  mass.phase.AddCoordinate("late");
  EXPECT_EQ(
      UnusedIn(mass.problem),
      "mass: phase 'lift': no dynamics, constraint or cost contains the derivative of order 2 of "
      "'late'");
}

TEST(UnusedQuantities, ImplicitDynamicsAndConstraintsAreDynamics) {
  FreeMass everywhere, knots, link;
  const auto rate = [](const FreeMass& mass) { return mass.phase.Rate(mass.q, 2); };
  everywhere.phase.Constrain("motion", Square(), {rate(everywhere)}, {{0, 0}});
  EXPECT_EQ(UnusedIn(everywhere.problem), "no error");
  knots.phase.ConstrainKnots("motion", Square(), {rate(knots)}, {{0, 1}});
  EXPECT_EQ(UnusedIn(knots.problem), "no error");
  link.problem.Link("start", Square(), {{rate(link), At::kStart}}, {{0, 1}});
  EXPECT_EQ(UnusedIn(link.problem), "no error");
}

TEST(UnusedQuantities, TheHighestDerivativeMayItselfBeTheControl) {
  FreeMass cost, end_cost, limited, held;
  cost.phase.AddIntegralCost("shake", Square(), {cost.phase.Rate(cost.q, 2)});
  EXPECT_EQ(UnusedIn(cost.problem), "no error");
  end_cost.problem.AddCost({end_cost.phase.Rate(end_cost.q, 2), At::kEnd});
  EXPECT_EQ(UnusedIn(end_cost.problem), "no error");
  limited.phase.Bound(limited.phase.Rate(limited.q, 2), {-kInfinity, 3});
  EXPECT_EQ(UnusedIn(limited.problem), "no error");
  held.phase.Fix(held.q, 0.5, At::kEverywhere);
  EXPECT_EQ(UnusedIn(held.problem), "no error");
}

TEST(UnusedQuantities, AControlWithoutUseIsRefused) {
  FreeMass mass;
  mass.phase.SetDynamics(Square(), {mass.q});
  const Variable force = mass.phase.AddControl("force", {-1, 1});
  EXPECT_EQ(UnusedIn(mass.problem),
            "mass: phase 'lift': no dynamics, constraint or cost contains the control 'force'");
  mass.problem.AddCost({force, At::kEnd});
  EXPECT_EQ(UnusedIn(mass.problem), "no error");
}

TEST(UnusedQuantities, AParameterWithoutUseIsRefused) {
  FreeMass mass;
  mass.phase.SetDynamics(Square(), {mass.q});
  const Variable used = mass.problem.AddParameter("used");
  mass.phase.Constrain("size", Square(), {used}, {{0, 1}});
  EXPECT_EQ(UnusedIn(mass.problem), "no error");
  mass.problem.AddParameter("gain");
  EXPECT_EQ(UnusedIn(mass.problem),
            "mass: no dynamics, constraint or cost contains the parameter 'gain'");
}

}  // namespace
}  // namespace possibility::collocation
