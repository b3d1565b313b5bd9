#include "collocation/study/multistart.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

/// A way from (-1, 0) to (1, 0) in 1 s round a disc of radius 0.5 at (0, `below`) with the least
/// integral of speed squared: above or below the disc.
struct RoundADisc {
  explicit RoundADisc(double below) : problem("round a disc") {
    Phase& phase = problem.AddPhase("go");
    x = phase.AddCoordinate("x");
    y = phase.AddCoordinate("y");
    phase.SetDuration(1);
    phase.Fix(x, -1, At::kStart);
    phase.Fix(x, 1, At::kEnd);
    phase.Fix(y, 0, At::kStart);
    phase.Fix(y, 0, At::kEnd);
    const auto square = [](auto a, auto b) { return a * a + b * b; };
    phase.AddIntegralCost("speed", FunctionOf(square), {phase.Rate(x), phase.Rate(y)});
    phase.Constrain(
        "clear", FunctionOf([below](auto a, auto b) { return a * a + (b - below) * (b - below); }),
        {x, y}, {{0.25, kInfinity}});
    phase.Guess(y, 0.3);
  }

  /// Length of the shortest way on one side: two tangents and an arc. Its square is the cost in
  /// 1 s.
  static double Length(double centre) {
    const double from = std::hypot(1, centre);
    const double tangent = std::sqrt(from * from - 0.25);
    // The angle at the centre between an end and the top of the disc, less that up to the tangent.
    const double arc = std::atan2(1, -centre) - std::acos(0.5 / from);
    return 2 * tangent + 2 * 0.5 * arc;
  }

  OptimalControlProblem problem;
  Variable x, y;
};

OptimalControlOptions FineMesh() {
  OptimalControlOptions options;
  options.intervals = {40};
  return options;
}

TEST(Multistart, MirrorImagesAreToldApart) {
  const RoundADisc task(0);
  const MultistartResult result = SolveFromManyStarts(task.problem, FineMesh());
  ASSERT_EQ(result.extremals.size(), 2u) << Summary(result);
  EXPECT_NEAR(result.extremals[0].result.objective, result.extremals[1].result.objective, 1e-4);
  EXPECT_LT(
      result.extremals[0].result.Value(task.y, 0.5) * result.extremals[1].result.Value(task.y, 0.5),
      0);
  EXPECT_EQ(result.extremals[0].count + result.extremals[1].count, 10) << Summary(result);
}

TEST(Multistart, TheShorterWayComesFirst) {
  const RoundADisc task(-0.1);
  MultistartSettings settings;
  settings.starts = 20;
  settings.noise = 2;
  const MultistartResult result = SolveFromManyStarts(task.problem, FineMesh(), settings);
  SCOPED_TRACE(Summary(result));
  ASSERT_EQ(result.extremals.size(), 2u) << Summary(result);
  const double above = RoundADisc::Length(-0.1);
  const double below = RoundADisc::Length(0.1);
  EXPECT_NEAR(result.extremals[0].result.objective, above * above, 0.01);
  EXPECT_NEAR(result.extremals[1].result.objective, below * below, 0.01);
}

TEST(Multistart, AConvexProblemHasOneExtremal) {
  OptimalControlProblem problem("block");
  Phase& phase = problem.AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  for (const At end : {At::kStart, At::kEnd}) phase.Fix(phase.Rate(x), 0, end);
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 1, At::kEnd);
  phase.AddIntegralCost("effort", FunctionOf([](auto u) { return u * u; }), {phase.Rate(x, 2)});
  OptimalControlOptions options;
  options.second_order_check = true;
  MultistartSettings settings;
  settings.starts = 4;
  settings.noise = 5;
  const MultistartResult result = SolveFromManyStarts(problem, options, settings);
  EXPECT_EQ(Summary(result), "12: 4 starts, a minimum\n");
}

TEST(Multistart, StartsThatFailAreCounted) {
  OptimalControlProblem problem("impossible");
  Phase& phase = problem.AddPhase("move");
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  phase.Bound(phase.Rate(x), {-1, 1});
  phase.Fix(x, 0, At::kStart);
  phase.Fix(x, 2, At::kEnd);
  MultistartSettings settings;
  settings.starts = 3;
  const MultistartResult result = SolveFromManyStarts(problem, {}, settings);
  EXPECT_TRUE(result.extremals.empty());
  int failures = 0;
  for (const auto& [message, count] : result.failures) failures += count;
  EXPECT_EQ(failures, 3);
}

TEST(Multistart, OneSeedGivesTheSameStarts) {
  const RoundADisc task(-0.1);
  MultistartSettings settings;
  settings.starts = 4;
  const auto objectives = [&] {
    const MultistartResult result = SolveFromManyStarts(task.problem, FineMesh(), settings);
    return std::pair(Summary(result), result.extremals.front().result.objective);
  };
  EXPECT_EQ(objectives(), objectives());
}

TEST(Multistart, SettingsThatMakeNoSenseAreRefused) {
  const RoundADisc task(0);
  const auto message = [&](const MultistartSettings& settings) {
    return MessageOf([&] { SolveFromManyStarts(task.problem, {}, settings); });
  };
  EXPECT_EQ(message({.starts = 0}), "multistart: 0 starts, expected 1 or more");
  EXPECT_EQ(message({.noise = -1}), "multistart: noise is -1, expected 0 or more");
  EXPECT_EQ(message({.same = 0}), "multistart: same is 0, expected more than 0");
}

}  // namespace
}  // namespace possibility::collocation
