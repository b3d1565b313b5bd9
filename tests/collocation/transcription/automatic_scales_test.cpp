#include "collocation/transcription/automatic_scales.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

/// Bryson & Ho 1975, section 2.5, in units that do not suit it: lengths and times in 1e-6 and 1e-3
/// of the first orbit's, the mass in 2.5e5 of the first mass. So radii are about 1e6, speeds 1e3
/// and masses 4e-6. Constant thrust for 3.32 units of time leads to the greatest circular orbit.
struct MisfitOrbit {
  static constexpr double kLength = 1e6, kTime = 1e3, kMass = 4e-6;
  static constexpr double kSpeed = kLength / kTime;
  static constexpr double kThrust = 0.1405 * kMass * kSpeed / kTime;

  MisfitOrbit() : problem("orbit"), thrust(problem.AddPhase("thrust")) {
    r = thrust.AddCoordinate("radius", {0.5 * kLength, 5 * kLength});
    out = thrust.AddCoordinate("radial speed");
    round = thrust.AddCoordinate("tangential speed");
    m = thrust.AddCoordinate("mass");
    a = thrust.AddControl("radial", {-1, 1});
    b = thrust.AddControl("tangential", {-1, 1});
    thrust.SetDuration(3.32 * kTime);
    thrust.SetDynamics(FunctionOf([](auto radius, auto u, auto v, auto mass, auto pa, auto pb) {
                         constexpr double kGravity = kLength * kLength * kLength / (kTime * kTime);
                         return std::array{
                             u, v * v / radius - kGravity / (radius * radius) + kThrust * pa / mass,
                             kThrust * pb / mass - u * v / radius,
                             0.0 * mass - 0.0749 * kMass / kTime};
                       }),
                       {r, out, round, m, a, b});
    thrust.Constrain("thrust", FunctionOf([](auto pa, auto pb) { return pa * pa + pb * pb; }),
                     {a, b}, {{0, 1}});
    thrust.Fix(r, kLength, At::kStart);
    thrust.Fix(out, 0, At::kStart);
    thrust.Fix(round, kSpeed, At::kStart);
    thrust.Fix(m, kMass, At::kStart);
    thrust.Fix(out, 0, At::kEnd);
    thrust.Constrain("circular", FunctionOf([](auto radius, auto v) { return radius * v * v; }),
                     {r, round}, {{kLength * kSpeed * kSpeed, kLength * kSpeed * kSpeed}},
                     At::kEnd);
    thrust.Guess(b, 1);
    problem.AddCost({r, At::kEnd}, -1 / kLength);
  }

  /// As one who knows the orbit would.
  void ScaleByHand() {
    const double acceleration = kSpeed / kTime;
    thrust.SetScale(r, kLength);
    for (const Variable speed : {out, round, thrust.Rate(r)}) thrust.SetScale(speed, kSpeed);
    for (const Variable speed : {out, round}) thrust.SetScale(thrust.Rate(speed), acceleration);
    thrust.SetScale(m, kMass);
    thrust.SetScale(thrust.Rate(m), kMass / kTime);
    thrust.SuggestRowScales(0, Eigen::Vector4d(kSpeed, acceleration, acceleration, kMass / kTime));
    thrust.SuggestRowScales(2, Eigen::VectorXd::Constant(1, kLength * kSpeed * kSpeed));
  }

  OptimalControlResult Solve() const {
    OptimalControlOptions options;
    options.intervals = {30};
    options.solver.max_iterations = 300;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem;
  Phase& thrust;
  Variable r, out, round, m, a, b;
};

TEST(AutomaticScales, NeedAboutTheIterationsOfThoseByHand) {
  constexpr double kOptimum = -1.52527770065;  // docs/collocation.md
  MisfitOrbit by_hand;
  by_hand.ScaleByHand();
  const OptimalControlResult hand = by_hand.Solve();
  ASSERT_TRUE(hand.succeeded()) << hand.message;
  EXPECT_NEAR(hand.objective, kOptimum, 1e-5);
  MisfitOrbit automatic;
  SetAutomaticScales(&automatic.problem);
  const OptimalControlResult result = automatic.Solve();
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, kOptimum, 1e-5);
  EXPECT_LE(result.iterations, 1.5 * hand.iterations) << hand.iterations;
  // With a scale of 1 for everything the solver does not get there.
  const OptimalControlResult raw = MisfitOrbit().Solve();
  EXPECT_FALSE(raw.succeeded() && std::abs(raw.objective - kOptimum) < 1e-2)
      << raw.iterations << " iterations: " << raw.message;
}

TEST(AutomaticScales, FollowFromBoundsGuessesAndJacobians) {
  OptimalControlProblem problem("sizes");
  Phase& phase = problem.AddPhase("only", 2);
  const Variable x = phase.AddCoordinate("x", {-3, 7});
  const Variable y = phase.AddCoordinate("y");
  const Variable z = phase.AddCoordinate("z");
  const Variable u = phase.AddControl("u");
  const Variable w = phase.AddControl("w", {-kInfinity, 0.5});
  const Variable mass = problem.AddParameter("mass", {1, 9}, {}, 4);
  const Variable given = problem.AddParameter("given", {1, 9}, 1, 4);
  phase.SetDuration(2);
  phase.Guess(y, [](double s) { return 1e4 * s; });
  phase.Bound(phase.Rate(y), {-300, 200});
  // x'' = 50 u + x, y'' = w, z'' = 0.01 u; x'' has the size 7 / 2 / 2.
  phase.SetDynamics(Differentiated<3, 3>([](const auto& v, auto* f) {
                      (*f)[0] = 50.0 * v[0] + v[1];
                      (*f)[1] = v[2];
                      (*f)[2] = 0.01 * v[0];
                    }),
                    {u, x, w});
  phase.Constrain("row", FunctionOf([](auto a, auto b, auto m) { return 3 * a + b * m; }),
                  {x, y, mass}, {{-1, 1}});
  phase.Constrain("own", FunctionOf([](auto a) { return 3 * a; }), {y}, {{-1, 1}}, At::kEverywhere,
                  {1});
  problem.AddCost({given, At::kEnd});
  SetAutomaticScales(&problem);
  const auto scale = [&](Variable variable) { return phase.Find(variable).scale; };
  EXPECT_EQ(scale(x), 7);
  EXPECT_EQ(scale(phase.Rate(x)), 3.5);
  EXPECT_EQ(scale(phase.Rate(x, 2)), 1.75);
  EXPECT_EQ(scale(y), 1e4);
  EXPECT_EQ(scale(phase.Rate(y)), 300);
  EXPECT_EQ(scale(phase.Rate(y, 2)), 150);
  EXPECT_EQ(scale(z), 1);
  EXPECT_EQ(scale(w), 0.5);
  EXPECT_NEAR(scale(u), 1.75 / 50, 1e-15);
  EXPECT_EQ(problem.parameters()[0].scale, 9);
  EXPECT_EQ(problem.parameters()[1].scale, 1);
  EXPECT_EQ(phase.constraints()[0].scales, Eigen::Vector3d(1.75, 150, 0.25));
  EXPECT_EQ(phase.constraints()[1].scales[0], 1e4 * 9);  // d row / d mass at the end of the guess
  EXPECT_EQ(phase.constraints()[2].scales[0], 1);
}

TEST(AutomaticScales, ThatWereGivenStay) {
  MisfitOrbit orbit;
  orbit.thrust.SetScale(orbit.r, 5e5);
  const Variable extra = orbit.thrust.AddControl("extra", {-100, 100}, 1);
  SetAutomaticScales(&orbit.problem);
  EXPECT_EQ(orbit.thrust.Find(orbit.r).scale, 5e5);
  EXPECT_EQ(orbit.thrust.Find(extra).scale, 1);
  EXPECT_EQ(orbit.thrust.Find(orbit.m).scale, MisfitOrbit::kMass);
  orbit.thrust.SetScale(orbit.m, 1);
  SetAutomaticScales(&orbit.problem);
  EXPECT_EQ(orbit.thrust.Find(orbit.m).scale, 1);
}

}  // namespace
}  // namespace possibility::collocation
