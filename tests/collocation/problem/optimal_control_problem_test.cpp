#include "collocation/problem/optimal_control_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

std::shared_ptr<Function> Same() {
  return Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = z[0]; });
}

/// Two problems of the same shape: every variable of one has a twin in the other.
struct Twin {
  explicit Twin(const std::string& name)
      : problem(name), run(problem.AddPhase("run")), fly(problem.AddPhase("fly")) {
    x = run.AddCoordinate("x");
    u = run.AddControl("u");
    y = fly.AddCoordinate("y");
    w = fly.AddControl("w");
    gain = problem.AddParameter("gain");
  }

  OptimalControlProblem problem;
  Phase& run;
  Phase& fly;
  Variable x, u, y, w, gain;
};

TEST(ForeignVariables, AreNotEqualToTheirTwins) {
  const Twin ours("ours"), theirs("theirs");
  EXPECT_EQ(ours.x, ours.run.Coordinate(0));
  EXPECT_NE(ours.x, theirs.x);
  EXPECT_NE(ours.gain, theirs.gain);
  EXPECT_NE(ours.run.duration(), theirs.run.duration());
}

TEST(ForeignVariables, OfAnotherPhaseAreRefusedByName) {
  Twin ours("ours");
  EXPECT_EQ(MessageOf([&] { ours.run.SetDynamics(Same(), {ours.w}); }),
            "ours: phase 'run': 'dynamics': argument 0 is 'fly: w', which is not of this phase");
  EXPECT_EQ(MessageOf([&] {
              ours.run.Constrain("c", Same(), {ours.fly.time()}, {{0, 0}});
            }),
            "ours: phase 'run': 'c': argument 0 is 'fly: time', which is not of this phase");
  EXPECT_EQ(MessageOf([&] {
              ours.run.Bound(ours.y, {0, 1});
            }),
            "ours: phase 'run': 'fly: y' is no coordinate or control of this phase");
  EXPECT_EQ(MessageOf([&] { ours.run.Guess(ours.fly.duration(), 1); }),
            "ours: phase 'run': 'fly: duration' is no coordinate or control of this phase");
  EXPECT_EQ(MessageOf([&] { ours.run.Rate(ours.y); }),
            "ours: phase 'run': 'fly: y' is no coordinate or control of this phase");
}

TEST(ForeignVariables, OfAnotherProblemAreRefusedByName) {
  Twin ours("ours");
  const Twin theirs("theirs");
  EXPECT_EQ(MessageOf([&] { ours.run.SetDynamics(Same(), {theirs.u}); }),
            "ours: phase 'run': 'dynamics': argument 0 is control 0 of another problem, which is "
            "not of this phase");
  EXPECT_EQ(MessageOf([&] { ours.run.AddIntegralCost("c", Same(), {theirs.gain}); }),
            "ours: phase 'run': 'c': argument 0 is parameter 0 of another problem, which is not "
            "of this phase");
  EXPECT_EQ(MessageOf([&] { ours.run.Fix(theirs.x, 0, At::kStart); }),
            "ours: phase 'run': coordinate 0 of another problem is no coordinate or control of "
            "this phase");
  EXPECT_EQ(MessageOf([&] { ours.run.Guess(theirs.run.duration(), 1); }),
            "ours: phase 'run': duration 0 of another problem is no coordinate or control of this "
            "phase");
}

TEST(ForeignVariables, OfAnotherProblemAreRefusedWherePhasesMeet) {
  Twin ours("ours");
  const Twin theirs("theirs");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.Link("jump", Same(), {{theirs.x, At::kEnd}}, {{0, 0}});
            }),
            "ours: 'jump': argument 0 is coordinate 0 of another problem");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.AddCost("goal", Same(), {{theirs.gain, At::kEnd}});
            }),
            "ours: 'goal': argument 0 is parameter 0 of another problem");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.AddCost({theirs.run.duration(), At::kEnd});
            }),
            "ours: duration 0 of another problem");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.Continue({ours.x, At::kEnd}, {theirs.y, At::kStart});
            }),
            "ours: coordinate 0 of another problem");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.Continue({ours.x, At::kEnd}, {ours.y, At::kStart});
            }),
            "no error");
}

/// A later problem may stand at the same address.
TEST(ForeignVariables, OfAProblemThatIsGoneAreRefused) {
  std::optional<Twin> twin(std::in_place, "first");
  const Variable stale = twin->u;
  twin.emplace("second");
  EXPECT_EQ(MessageOf([&] { twin->run.SetDynamics(Same(), {stale}); }),
            "second: phase 'run': 'dynamics': argument 0 is control 0 of another problem, which is "
            "not of this phase");
}

TEST(ForeignVariables, ThatNoProblemGaveAreRefused) {
  Twin ours("ours");
  EXPECT_EQ(MessageOf([&] { ours.run.SetDynamics(Same(), {Variable{}}); }),
            "ours: phase 'run': 'dynamics': argument 0 is coordinate 0 of no problem, which is not "
            "of this phase");
  EXPECT_EQ(ours.problem.NameOf(ours.fly.Rate(ours.y)), "fly: y'");
}

TEST(Integrals, ThatAreNoneAreRefusedByName) {
  Twin ours("ours");
  const auto two = Differentiated<1, 2>([](const auto& z, auto* y) { (*y)[0] = (*y)[1] = z[0]; });
  const auto add = [&](const std::shared_ptr<Function>& f, Variable x, Bounds bounds,
                       double scale) {
    return MessageOf([&] { ours.run.ConstrainIntegral("area", f, {x}, bounds, scale); });
  };
  EXPECT_EQ(add(two, ours.x, {0, 1}, 1), "ours: phase 'run': integral 'area' has 2 outputs");
  EXPECT_EQ(add(Same(), ours.w, {0, 1}, 1),
            "ours: phase 'run': 'area': argument 0 is 'fly: w', which is not of this phase");
  EXPECT_EQ(add(Same(), ours.x, {1, 0}, 1),
            "ours: phase 'run': 'area': contradictory bounds [1, 0]");
  EXPECT_EQ(add(Same(), ours.x, {0, 1}, 0),
            "ours: phase 'run': 'area': expected a scale above 0, got 0");
  EXPECT_EQ(add(Same(), ours.x, {0, 1}, 1), "no error");
  EXPECT_EQ(add(Same(), ours.x, {0, 1}, 1), "ours: phase 'run': two constraints are named 'area'");
}

TEST(Instants, OutsideThePhaseAreRefusedByName) {
  Twin ours("ours");
  EXPECT_EQ(MessageOf([&] { ours.problem.AddCost("data", Same(), {AtShare(ours.x, 1.2)}); }),
            "ours: 'data': 'run: x' at the share 1.2 of its phase, expected 0 to 1");
  EXPECT_EQ(MessageOf([&] {
              ours.problem.Link("gate", Same(), {AtShare(ours.x, std::nan(""))}, {{0, 1}});
            }),
            "ours: 'gate': 'run: x' at the share nan of its phase, expected 0 to 1");
}

}  // namespace
}  // namespace possibility::collocation
