#include "graph/action/job_control.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "tests/graph/steered_routine.h"
#include "tests/graph/wait.h"

namespace possibility::graph {
namespace {

using std::chrono::milliseconds;
using test::Wait;

TEST(JobControl, APausedJobWaitsAtItsCheckpointUntilResumed) {
  std::atomic<int> held = 0;
  std::atomic<int> steps = 0;
  JobControl control([&] { ++held; });
  std::thread job([&] {
    while (control.Checkpoint()) {
      ++steps;
      std::this_thread::sleep_for(milliseconds(1));
    }
  });
  for (int round = 1; round <= 20; ++round) {
    const int before = steps;
    EXPECT_TRUE(Wait([&] { return steps > before; }));
    EXPECT_FALSE(control.Pause());
    EXPECT_TRUE(Wait([&] { return held == round; }));
    EXPECT_FALSE(control.Pause());
    const int at_pause = steps;
    std::this_thread::sleep_for(milliseconds(3));
    EXPECT_EQ(steps, at_pause);
    control.Resume();
  }
  control.Cancel();
  job.join();
  EXPECT_TRUE(control.cancelled());
  EXPECT_FALSE(control.Checkpoint());
}

TEST(JobControl, ARationEndsAtTheSameCheckpointEveryTime) {
  constexpr int kRation = 7;
  std::atomic<int> held = 0;
  std::atomic<int> steps = 0;
  JobControl control([&] { ++held; });
  control.Ration(kRation);
  std::thread job([&] {
    while (control.Checkpoint()) {
      ++steps;
    }
  });
  for (int round = 1; round <= 100; ++round) {
    EXPECT_TRUE(Wait([&] { return held == round; }));
    EXPECT_EQ(steps, kRation * round - 1);
    control.Ration(kRation);
    control.Resume();
  }
  control.Cancel();
  job.join();
}

TEST(JobControl, ASteeredRoutineThatIsChargedStopsWhenTheRationIsUsedUp) {
  std::atomic<int> held = 0;
  std::atomic<int> steps = 0;
  JobControl control([&] { ++held; });
  control.Ration(1 + 4 * 3);  // one for the checkpoint before the routine
  test::SteeredRoutine routine;
  const auto step = [&] {
    ++steps;
    control.Charge(4);
    return true;
  };
  std::thread job([&] {
    control.RunSteered(routine.Steering(), [&] {
      // In a thread of its own, like a solve that several jobs share.
      std::jthread([&] { routine.Run(step); }).join();
    });
  });
  for (int round = 1; round <= 5; ++round) {
    EXPECT_TRUE(Wait([&] { return held == round; }));
    std::this_thread::sleep_for(milliseconds(5));
    EXPECT_EQ(steps, 3 * round);
    EXPECT_FALSE(control.Pause()) << "held itself";
    control.Ration(4 * 3);
    control.Resume();
  }
  control.Cancel();
  job.join();
}

TEST(JobControl, CancelEndsAPauseAndIsFinal) {
  JobControl control;
  control.Pause();
  std::thread job([&] { EXPECT_FALSE(control.Checkpoint()); });
  control.Cancel();
  job.join();
  control.Resume();
  EXPECT_FALSE(control.Pause());
  EXPECT_FALSE(control.Checkpoint());
}

TEST(JobControl, AskingItsTokenIsACheckpoint) {
  int held = 0;
  JobControl control([&] {
    ++held;
    control.Cancel();
  });
  const CancellationToken token = control.token();
  control.Ration(3);
  EXPECT_TRUE(token.Proceed());
  EXPECT_TRUE(token.Proceed());
  EXPECT_EQ(held, 0);
  EXPECT_THROW(token.ThrowIfCancelled(), Cancelled);
  EXPECT_EQ(held, 1);
}

TEST(JobControl, ASteeredRoutineIsPausedResumedAndCancelledThroughItsHandle) {
  JobControl control;
  test::SteeredRoutine routine;
  std::atomic<int> steps = 0;
  const auto step = [&] { return ++steps > 0; };
  std::thread job(
      [&] { EXPECT_FALSE(control.RunSteered(routine.Steering(), [&] { routine.Run(step); })); });
  EXPECT_TRUE(Wait([&] { return steps > 2; }));
  EXPECT_TRUE(control.Pause());
  std::this_thread::sleep_for(milliseconds(10));
  const int at_pause = steps;
  std::this_thread::sleep_for(milliseconds(10));
  EXPECT_EQ(steps, at_pause);
  control.Resume();
  EXPECT_TRUE(Wait([&] { return steps > at_pause + 2; }));
  control.Cancel();
  job.join();
}

TEST(JobControl, ARoutineThatEndsDuringAPauseIsHeldAfterwards) {
  JobControl control;
  std::atomic<bool> begun = false;
  std::atomic<bool> finish = false;
  std::atomic<bool> returned = false;
  const JobSteering deaf = {.pause = [] {}, .resume = [] {}, .cancel = [] {}};
  std::thread job([&] {
    EXPECT_TRUE(control.RunSteered(deaf, [&] {
      begun = true;
      EXPECT_TRUE(Wait([&] { return finish.load(); }));
    }));
    returned = true;
  });
  EXPECT_TRUE(Wait([&] { return begun.load(); }));
  EXPECT_TRUE(control.Pause());
  finish = true;
  std::this_thread::sleep_for(milliseconds(10));
  EXPECT_FALSE(returned);
  control.Resume();
  job.join();
  EXPECT_TRUE(returned);
}

TEST(JobControl, ACancelledJobDoesNotEnterARoutine) {
  JobControl control;
  control.Cancel();
  EXPECT_FALSE(control.RunSteered({}, [] { FAIL(); }));
}

TEST(JobControl, AnExceptionOfARoutinePassesAndLeavesTheControlUsable) {
  JobControl control;
  const JobSteering never = {
      .pause = [] { FAIL(); }, .resume = [] { FAIL(); }, .cancel = [] { FAIL(); }};
  EXPECT_THROW(control.RunSteered(never, [] { throw std::runtime_error("no"); }),
               std::runtime_error);
  EXPECT_TRUE(control.Checkpoint());
  control.Pause();
  control.Resume();
  control.Cancel();
}

}  // namespace
}  // namespace possibility::graph
