#include <gtest/gtest.h>
#include <time.h>

#include <atomic>
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

/// A source that pauses and cancels a solve from other threads.
class Steering {
 public:
  CancellationToken token() {
    return CancellationToken([this] {
      paused_.wait(true);
      return !cancelled_;
    });
  }
  void Pause() { paused_ = true; }
  void Resume() {
    paused_ = false;
    paused_.notify_all();
  }
  void Cancel() {
    cancelled_ = true;
    Resume();
  }

 private:
  std::atomic<bool> paused_ = false;
  std::atomic<bool> cancelled_ = false;
};

double ThreadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST(CancelledSolve, ASolveCancelledBeforehandEndsAtOnce) {
  for (const auto linear : {LinearSolver::kSparseLdlt, LinearSolver::kMumps}) {
    PendulumChain program = ShortProgram();
    Steering steering;
    steering.Cancel();
    SolverOptions options;
    options.linear_solver = linear;
    const SolverResult result =
        Solve(&program, {program.Guess(), {}, {}, {}}, options, steering.token());
    EXPECT_EQ(result.status, SolverStatus::kCancelled);
    EXPECT_EQ(result.message, "cancelled");
    EXPECT_EQ(result.x, program.Guess());
    EXPECT_TRUE(result.history.empty());
  }
}

TEST(CancelledSolve, CancelEndsASolveSoon) {
  PendulumChain program = LongProgram();
  for (const int milliseconds : {0, 3, 30, 100, 300}) {
    Steering steering;
    Clock::time_point told;
    std::jthread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      told = Clock::now();
      steering.Cancel();
    });
    const SolverResult result =
        Solve(&program, {program.Guess(), {}, {}, {}}, {}, steering.token());
    const Clock::time_point ended = Clock::now();
    other.join();
    EXPECT_EQ(result.status, SolverStatus::kCancelled) << result.message;
    EXPECT_LT(Seconds(ended - told).count(), 1);
    EXPECT_TRUE(result.x.allFinite());
    RecordProperty(std::to_string(milliseconds), std::to_string(Seconds(ended - told).count()));
  }
}

TEST(CancelledSolve, CancelEndsThePauseAndTheWaitForATurn) {
  PendulumChain waiting_program = ShortProgram(), program = ShortProgram();
  SolverOptions options;
  options.linear_solver = LinearSolver::kMumps;
  Steering paused, waiting;
  std::atomic<int> iterations = 0;
  SolverResult first, second;
  std::jthread holder([&] {
    first = Solve(&program, {program.Guess(), {}, {}, {}}, options, paused.token(),
                  [&](const SolverIteration&) {
                    paused.Pause();
                    ++iterations;
                  });
  });
  while (iterations == 0) std::this_thread::yield();
  std::jthread queued([&] {
    second =
        Solve(&waiting_program, {waiting_program.Guess(), {}, {}, {}}, options, waiting.token());
  });
  waiting.Cancel();
  queued.join();
  EXPECT_EQ(second.status, SolverStatus::kCancelled);
  paused.Cancel();
  holder.join();
  EXPECT_EQ(first.status, SolverStatus::kCancelled);
  EXPECT_EQ(iterations, 1);
}

TEST(CancelledSolve, APausedSolveSleepsAndResumesToTheSameAnswer) {
  PendulumChain program = ShortProgram();
  const SolverGuess guess{program.Guess(), {}, {}, {}};
  const SolverResult straight = Solve(&program, guess);
  ASSERT_TRUE(straight.succeeded()) << straight.message;

  Steering steering;
  SolverOptions options;
  options.time_limit = 20;
  std::atomic<bool> is_paused = false;
  double cpu_before = 0, cpu_after = 0;
  std::jthread other([&] {
    while (!is_paused) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    steering.Resume();
  });
  const Clock::time_point start = Clock::now();
  const SolverResult result =
      Solve(&program, guess, options, steering.token(), [&](const SolverIteration& iteration) {
        if (iteration.number == 5) {
          cpu_before = ThreadSeconds();
          steering.Pause();  // the solve sleeps at its next step
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

TEST(CancelledSolve, TheTimeLimitHoldsAndDoesNotCountPauses) {
  PendulumChain program = LongProgram();
  const SolverGuess guess{program.Guess(), {}, {}, {}};
  SolverOptions options;
  options.time_limit = 0.2;
  Steering steering;
  steering.Pause();
  std::jthread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    steering.Resume();
  });
  const Clock::time_point start = Clock::now();
  const SolverResult result = Solve(&program, guess, options, steering.token());
  const double wall = Seconds(Clock::now() - start).count();
  EXPECT_EQ(result.status, SolverStatus::kTimeLimit) << result.message;
  EXPECT_GE(result.times.total, 0.2);
  EXPECT_LT(result.times.total, wall - 0.45);  // the pause used nothing up
  EXPECT_LT(wall, 2.5);
}

}  // namespace
}  // namespace possibility::collocation
