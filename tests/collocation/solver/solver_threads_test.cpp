#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "collocation/solver/solver.h"
#include "tests/collocation/solver/pendulum_chain.h"

namespace possibility::collocation {
namespace {

PendulumChain::Settings Variant(int k) {
  PendulumChain::Settings settings;
  settings.pendulums = 1 + k % 3;
  settings.knots = 12 + k % 5;
  settings.effort = 1 + 0.1 * (k % 7);
  return settings;
}

SolverResult SolveVariant(int k, LinearSolver linear) {
  PendulumChain program(Variant(k));
  SolverOptions options;
  options.linear_solver = linear;
  return Solve(&program, {program.Guess(), {}, {}, {}}, options);
}

/// Solves variants 0..count-1, eight threads at a time.
std::vector<SolverResult> SolveAll(int count, int variants, LinearSolver linear) {
  std::vector<SolverResult> results(count);
  std::atomic<int> next = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (int k = next++; k < count; k = next++) results[k] = SolveVariant(k % variants, linear);
      });
    }
  }
  return results;
}

void ExpectSameAsSerial(int count, int variants, LinearSolver linear) {
  std::vector<SolverResult> serial;
  for (int k = 0; k < variants; ++k) serial.push_back(SolveVariant(k, linear));
  const std::vector<SolverResult> results = SolveAll(count, variants, linear);
  for (int k = 0; k < count; ++k) {
    const SolverResult& expected = serial[k % variants];
    ASSERT_EQ(results[k].status, expected.status) << k;
    ASSERT_EQ(results[k].x, expected.x) << k;  // bit for bit
    ASSERT_EQ(results[k].constraint_multipliers, expected.constraint_multipliers) << k;
    ASSERT_EQ(results[k].history.size(), expected.history.size()) << k;
  }
}

TEST(SolverThreads, EightSolvesAtATimeEqualTheSerialSolves) {
  ExpectSameAsSerial(48, 12, LinearSolver::kSparseLdlt);
}

TEST(SolverThreads, MumpsSolvesByEightThreadsEqualTheSerialSolves) {
  ExpectSameAsSerial(16, 4, LinearSolver::kMumps);
}

TEST(SolverThreadsLong, FiveHundredSolvesEightAtATimeEqualTheSerialSolves) {
  ExpectSameAsSerial(500, 35, LinearSolver::kSparseLdlt);
}

}  // namespace
}  // namespace possibility::collocation
