#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

/// A block of 1 kg that moves by 1 m in 1 s from rest to rest, which takes 4 N; beside it a sledge
/// that moves freely.
struct BlockAndSledge {
  explicit BlockAndSledge(double most_force)
      : problem("block and sledge"),
        phase(problem.AddPhase("move", 2)),
        x(phase.AddCoordinate("x")),
        sledge(phase.AddCoordinate("sledge")),
        force(phase.AddControl("force", {-most_force, most_force})),
        pull(phase.AddControl("pull", {-50, 50})) {
    phase.SetDuration(1);
    phase.SetDynamics(Differentiated<2, 2>([](const auto& u, auto* a) {
                        (*a)[0] = u[0];
                        (*a)[1] = u[1];
                      }),
                      {force, pull});
    for (const Variable coordinate : {x, sledge}) {
      phase.Fix(coordinate, 0, At::kStart);
      phase.Fix(coordinate, 1, At::kEnd);
      for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(coordinate), 0, end);
    }
    phase.AddIntegralCost("effort", FunctionOf([](auto f) { return f * f; }), {pull});
  }

  OptimalControlResult Solve() const {
    OptimalControlOptions options;
    options.explain_infeasible = true;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem;
  Phase& phase;
  Variable x, sledge, force, pull;
};

bool Mentions(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(), [&text](const std::string& line) {
    return line.find(text) != std::string::npos;
  });
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(Conflict, NamesTheBoundsThatStandAgainstEachOtherAndNoOthers) {
  const OptimalControlResult result = BlockAndSledge(3).Solve();
  EXPECT_FALSE(result.succeeded());
  const std::string all = Joined(result.conflict);
  EXPECT_TRUE(Mentions(result.conflict, "move: force is at most 3")) << all;
  EXPECT_TRUE(Mentions(result.conflict, "move: force is at least -3")) << all;
  EXPECT_TRUE(Mentions(result.conflict, "move: x is fixed at 1")) << all;
  EXPECT_FALSE(Mentions(result.conflict, "sledge")) << all;
  EXPECT_FALSE(Mentions(result.conflict, "pull")) << all;
}

TEST(Conflict, IsEmptyWhereTheProblemIsFeasible) {
  const OptimalControlResult result = BlockAndSledge(5).Solve();
  EXPECT_TRUE(result.succeeded());
  EXPECT_TRUE(result.conflict.empty());
}

TEST(Conflict, NamesTwoConstraintsThatExcludeEachOther) {
  OptimalControlProblem problem("two walls");
  Phase& phase = problem.AddPhase("stand", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("u", {-9, 9});
  phase.SetDuration(1);
  phase.SetDynamics(FunctionOf([](auto f) { return f; }), {u});
  phase.Constrain("left wall", FunctionOf([](auto at) { return at + 0.1 * at * at; }), {x},
                  {{1, kInfinity}});
  phase.Constrain("right wall", FunctionOf([](auto at) { return at; }), {x}, {{-kInfinity, 0.5}});
  phase.Constrain("ceiling", FunctionOf([](auto at) { return at; }), {x}, {{-kInfinity, 20}});
  OptimalControlOptions options;
  options.intervals = {3};
  options.explain_infeasible = true;
  const OptimalControlResult result = SolveOptimalControl(problem, options);
  EXPECT_FALSE(result.succeeded());
  const std::string all = Joined(result.conflict);
  EXPECT_TRUE(Mentions(result.conflict, "stand: left wall")) << all;
  EXPECT_TRUE(Mentions(result.conflict, "stand: right wall")) << all;
  EXPECT_FALSE(Mentions(result.conflict, "ceiling")) << all;
  EXPECT_EQ(result.conflict.size(), 2) << all;
}

TEST(Conflict, IsNotSoughtUnlessAskedFor) {
  const BlockAndSledge block(3);
  EXPECT_TRUE(SolveOptimalControl(block.problem).conflict.empty());
}

}  // namespace
}  // namespace possibility::collocation
