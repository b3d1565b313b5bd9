#include "collocation/solver/solve_control.h"

#include <gtest/gtest.h>
#include <time.h>

#include <chrono>
#include <thread>

#include "collocation/solver/solver.h"
#include "tests/collocation/solver/pendulum_chain.h"

namespace possibility::collocation {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

PendulumChain LongProgram() {
  PendulumChain::Settings settings;
  settings.knots = 700;
  return PendulumChain(settings);
}

PendulumChain ShortProgram() {
  PendulumChain::Settings settings;
  settings.pendulums = 2;
  settings.knots = 60;
  settings.effort = 2;
  return PendulumChain(settings);
}

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST(SolveControl, ASolveCancelledBeforehandEndsAtOnce) {
  for (const auto linear : {LinearSolver::kSparseLdlt, LinearSolver::kMumps}) {
    PendulumChain program = ShortProgram();
    SolveControl control;
    control.Cancel();
    SolverOptions options;
    options.linear_solver = linear;
    const SolverResult result = Solve(&program, {program.Guess(), {}, {}, {}}, options, &control);
    EXPECT_EQ(result.status, SolverStatus::kCancelled);
    EXPECT_EQ(result.message, "cancelled");
    EXPECT_EQ(result.x, program.Guess());
    EXPECT_TRUE(result.history.empty());
  }
}

TEST(SolveControl, CancelEndsASolveSoon) {
  PendulumChain program = LongProgram();
  for (const int milliseconds : {0, 3, 30, 100, 300}) {
    SolveControl control;
    Clock::time_point told;
    std::jthread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      told = Clock::now();
      control.Cancel();
    });
    const SolverResult result = Solve(&program, {program.Guess(), {}, {}, {}}, {}, &control);
    const Clock::time_point ended = Clock::now();
    other.join();
    EXPECT_EQ(result.status, SolverStatus::kCancelled) << result.message;
    EXPECT_LT(Seconds(ended - told).count(), 1);
    EXPECT_TRUE(result.x.allFinite());
    RecordProperty(std::to_string(milliseconds), std::to_string(Seconds(ended - told).count()));
  }
}

TEST(SolveControl, CancelEndsThePauseAndTheWaitForATurn) {
  PendulumChain waiting_program = ShortProgram(), program = ShortProgram();
  SolverOptions options;
  options.linear_solver = LinearSolver::kMumps;
  SolveControl paused, waiting;
  std::atomic<int> iterations = 0;
  SolverResult first, second;
  std::jthread holder([&] {
    first = Solve(&program, {program.Guess(), {}, {}, {}}, options, &paused,
                  [&](const SolverIteration&) {
                    paused.Pause();
                    ++iterations;
                  });
  });
  while (iterations == 0) std::this_thread::yield();
  std::jthread queued([&] {
    second = Solve(&waiting_program, {waiting_program.Guess(), {}, {}, {}}, options, &waiting);
  });
  waiting.Cancel();
  queued.join();
  EXPECT_EQ(second.status, SolverStatus::kCancelled);
  paused.Cancel();
  holder.join();
  EXPECT_EQ(first.status, SolverStatus::kCancelled);
  EXPECT_EQ(iterations, 1);
}

TEST(SolveControl, APausedSolveSleepsAndResumesToTheSameAnswer) {
  PendulumChain program = ShortProgram();
  const SolverGuess guess{program.Guess(), {}, {}, {}};
  const SolverResult straight = Solve(&program, guess);
  ASSERT_TRUE(straight.succeeded()) << straight.message;

  SolveControl control;
  SolverOptions options;
  options.time_limit = 20;
  std::atomic<bool> is_paused = false;
  double cpu_before = 0, cpu_after = 0;
  std::jthread other([&] {
    while (!is_paused) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    control.Resume();
  });
  const Clock::time_point start = Clock::now();
  const SolverResult result =
      Solve(&program, guess, options, &control, [&](const SolverIteration& iteration) {
        if (iteration.number == 5) {
          cpu_before = ThreadSeconds();
          control.Pause();  // the solve sleeps at its next step
          is_paused = true;
        }
        if (iteration.number == 6) cpu_after = ThreadSeconds();
      });
  const double wall = Seconds(Clock::now() - start).count();
  EXPECT_EQ(result.status, straight.status);
  EXPECT_EQ(result.x, straight.x);
  EXPECT_EQ(result.history.size(), straight.history.size());
  EXPECT_GT(wall, 0.4);
  EXPECT_LT(result.times.total, wall - 0.39);
  EXPECT_LT(cpu_after - cpu_before, 0.2);  // an iteration takes about a millisecond
}

TEST(SolveControl, TheTimeLimitHoldsAndDoesNotCountPauses) {
  PendulumChain program = LongProgram();
  const SolverGuess guess{program.Guess(), {}, {}, {}};
  SolverOptions options;
  options.time_limit = 0.2;
  SolveControl control;
  control.Pause();
  std::jthread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    control.Resume();
  });
  const Clock::time_point start = Clock::now();
  const SolverResult result = Solve(&program, guess, options, &control);
  const double wall = Seconds(Clock::now() - start).count();
  EXPECT_EQ(result.status, SolverStatus::kTimeLimit) << result.message;
  EXPECT_GE(result.times.total, 0.2);
  EXPECT_LT(result.times.total, wall - 0.45);  // the pause used nothing up
  EXPECT_LT(wall, 2.5);
}

}  // namespace
}  // namespace possibility::collocation
