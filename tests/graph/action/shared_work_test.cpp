#include "graph/action/shared_work.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include "tests/graph/wait.h"

namespace possibility::graph {
namespace {

using test::Wait;

/// Work of a number of steps of about a millisecond.
class CountedWork {
 public:
  explicit CountedWork(int steps)
      : work_([this, steps](SharedWork* self) {
          const CancellationToken token = self->charging_token();
          for (int i = 0; i < steps; ++i) {
            token.ThrowIfCancelled();
            ++done_;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}
  SharedWork& work() { return work_; }
  int done() const { return done_; }

 private:
  std::atomic<int> done_ = 0;
  SharedWork work_;
};

/// A job that waits for work on a thread of its own.
class WaitingJob {
 public:
  explicit WaitingJob(SharedWork* work)
      : thread_([this, work] {
          has_ended_ = work->Await(&control_);
          is_over_ = true;
        }) {}
  ~WaitingJob() {
    control_.Cancel();
    thread_.join();
  }
  JobControl& control() { return control_; }
  bool is_over() const { return is_over_; }
  bool has_ended() const { return has_ended_; }

 private:
  JobControl control_;
  std::atomic<bool> has_ended_ = false;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

constexpr int kEndless = 1'000'000;

TEST(SharedWork, AllJobsGetTheEndOfOneRun) {
  CountedWork counted(20);
  WaitingJob first(&counted.work()), second(&counted.work());
  EXPECT_TRUE(Wait([&] { return first.is_over() && second.is_over(); }));
  EXPECT_TRUE(first.has_ended() && second.has_ended());
  EXPECT_EQ(counted.done(), 20);
  JobControl later;
  EXPECT_TRUE(counted.work().Await(&later)) << "known by then";
  EXPECT_EQ(counted.done(), 20);
}

TEST(SharedWork, ProgressSurvivesACancelledJob) {
  CountedWork counted(60);
  int before = 0;
  {
    WaitingJob cancelled(&counted.work());
    EXPECT_TRUE(Wait([&] { return counted.done() > 10; }));
    cancelled.control().Cancel();
    EXPECT_TRUE(Wait([&] { return cancelled.is_over(); }));
    EXPECT_FALSE(cancelled.has_ended());
    before = counted.done();
  }
  WaitingJob other(&counted.work());
  EXPECT_TRUE(Wait([&] { return other.is_over(); }));
  EXPECT_TRUE(other.has_ended());
  EXPECT_EQ(counted.done(), 60) << "with " << before << " of the first job's";
}

TEST(SharedWork, NothingIsDoneUnlessAJobWaits) {
  CountedWork counted(kEndless);
  const auto stands_still = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the step under way ends
    const int at_pause = counted.done();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return counted.done() == at_pause;
  };
  EXPECT_TRUE(stands_still());
  EXPECT_EQ(counted.done(), 0);
  WaitingJob one(&counted.work()), two(&counted.work());
  const auto goes_on = [&] {
    return Wait([&, before = counted.done()] { return counted.done() > before + 3; });
  };
  EXPECT_TRUE(goes_on());
  one.control().Pause();
  EXPECT_TRUE(goes_on()) << "for the other job";
  two.control().Pause();
  EXPECT_TRUE(stands_still());
  one.control().Resume();
  EXPECT_TRUE(goes_on());
  one.control().Cancel();
  EXPECT_TRUE(Wait([&] { return one.is_over(); }));
  EXPECT_TRUE(stands_still()) << "the other job is still paused";
}

TEST(SharedWork, ARationOfAJobEndsAtTheSameStepEveryTime) {
  constexpr int kRation = 7;
  for (int trial = 0; trial < 20; ++trial) {
    CountedWork counted(kEndless);
    std::atomic<int> held = 0;
    JobControl control([&] { ++held; });
    control.Ration(kRation);
    std::thread job([&] { counted.work().Await(&control); });
    for (int round = 1; round <= 3; ++round) {
      EXPECT_TRUE(Wait([&] { return held == round; }));
      // The checkpoint before the wait is charged, and the work stops before the step after it.
      EXPECT_EQ(counted.done(), kRation * round - 2);
      control.Ration(kRation);
      control.Resume();
    }
    control.Cancel();
    job.join();
  }
}

TEST(SharedWork, EveryJobGetsTheException) {
  SharedWork work([](SharedWork*) { throw std::runtime_error("no motion"); });
  for (int i = 0; i < 2; ++i) {
    JobControl control;
    EXPECT_THROW(work.Await(&control), std::runtime_error);
  }
}

TEST(SharedWork, EndsWithItsOwner) {
  std::atomic<bool> was_cancelled = false;
  {
    SharedWork work([&](SharedWork* self) {
      const CancellationToken token = self->token();
      while (token.Proceed()) std::this_thread::yield();
      was_cancelled = true;
    });
    WaitingJob job(&work);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    job.control().Cancel();
    EXPECT_TRUE(Wait([&] { return job.is_over(); }));
    EXPECT_FALSE(was_cancelled);
  }
  EXPECT_TRUE(was_cancelled);
}

}  // namespace
}  // namespace possibility::graph
