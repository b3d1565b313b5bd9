#include "graph/confirmation/confirmation_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "tests/graph/scripted_job.h"
#include "tests/graph/steered_routine.h"

namespace possibility::graph {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::Ending;
using test::ScriptedJob;

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Runs the queue until there are `count` results, at most for `limit`.
std::vector<JobResult> Collect(ConfirmationQueue* queue, int workers, std::size_t count,
                               double limit = 10) {
  std::vector<JobResult> all;
  const Deadline deadline(limit);
  while (all.size() < count && !deadline.Passed()) {
    if (workers == 0) {
      queue->RunTurn(deadline);
    } else {
      queue->WaitForResult(milliseconds(20));
    }
    for (JobResult& result : queue->DrainFinished()) {
      all.push_back(std::move(result));
    }
  }
  return all;
}

std::unique_ptr<ScriptedJob> Job(Ending ending, int steps, microseconds per_step = {}) {
  return std::make_unique<ScriptedJob>(ending, steps, per_step);
}

class WithWorkers : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(ConfirmationQueue, WithWorkers, ::testing::Values(0, 1, 2));

TEST_P(WithWorkers, EveryJobGivesItsOwnOutcomeAndReason) {
  ConfirmationQueue queue({.slice = milliseconds(1),
                           .slices_per_turn = 3,
                           .checkpoints_per_turn = 6,
                           .max_threads = 60});
  queue.LaunchThreads(GetParam());
  const std::vector<Ending> endings = {Ending::kConfirm, Ending::kRefute, Ending::kThrow,
                                       Ending::kGiveUp, Ending::kNonsense};
  for (int tag = 0; tag < 60; ++tag) {
    queue.Insert(tag, Job(endings[tag % 5], 1 + tag % 10, microseconds(200)), tag % 7);
  }
  EXPECT_EQ(queue.num_open(), 60);
  std::map<int, JobResult> by_tag;
  for (JobResult& result : Collect(&queue, GetParam(), 60)) {
    by_tag[result.tag] = result;
  }
  ASSERT_EQ(by_tag.size(), 60);
  EXPECT_EQ(queue.num_open(), 0);
  for (const auto& [tag, result] : by_tag) {
    const JobOutcome expected[] = {JobOutcome::kConfirmed, JobOutcome::kRefuted,
                                   JobOutcome::kFailed, JobOutcome::kFailed, JobOutcome::kFailed};
    const char* reasons[] = {"", "torque limit", "solver broke down", "too many iterations",
                             "the job returned no verdict that there is"};
    EXPECT_EQ(result.outcome, expected[tag % 5]);
    EXPECT_EQ(result.reason, reasons[tag % 5]);
  }
}

TEST_P(WithWorkers, EasyJobsEndBesideEndlessOnes) {
  ConfirmationQueue queue(
      {.slice = milliseconds(1), .slices_per_turn = 5, .checkpoints_per_turn = 10});
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 8; ++tag) {
    queue.Insert(tag, Job(Ending::kNever, 0), 1);
  }
  queue.Insert(8, Job(Ending::kConfirm, 12, milliseconds(1)), 2);
  const auto results = Collect(&queue, GetParam(), 1);
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].tag, 8);
  EXPECT_GT(results[0].seconds, 0.011);
}

TEST_P(WithWorkers, CancelAllEndsEveryJobAndItsThread) {
  ConfirmationQueue queue;
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 50; ++tag) {
    queue.Insert(tag, Job(Ending::kNever, 0), 0);
  }
  EXPECT_TRUE(Collect(&queue, GetParam(), 1, 0.05).empty());
  queue.CancelAll("the search is over");
  const auto results = queue.DrainFinished();
  EXPECT_EQ(results.size(), 50);
  EXPECT_EQ(queue.num_open(), 0);
  double seconds = 0;
  for (const JobResult& result : results) {
    EXPECT_EQ(result.outcome, JobOutcome::kCancelled);
    EXPECT_EQ(result.reason, "the search is over");
    seconds += result.seconds;
  }
  EXPECT_GT(seconds, 0);
}

TEST_P(WithWorkers, ACancelledJobEndsAndTheOthersGoOn) {
  ConfirmationQueue queue(
      {.slice = milliseconds(2), .slices_per_turn = 5, .checkpoints_per_turn = 4});
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 6; ++tag) {
    queue.Insert(tag, Job(tag % 2 ? Ending::kConfirm : Ending::kNever, 10, milliseconds(1)), 0);
  }
  // On a busy machine, some of the jobs that confirm may have ended by then.
  std::vector<JobResult> results = Collect(&queue, GetParam(), 1, 0.005);
  for (const int tag : {0, 2, 4, 4, 99}) {
    queue.Cancel(tag, "a detour is confirmed");
  }
  const auto others = Collect(&queue, GetParam(), 6 - static_cast<int>(results.size()));
  results.insert(results.end(), others.begin(), others.end());
  ASSERT_EQ(results.size(), 6);
  for (const JobResult& result : results) {
    EXPECT_EQ(result.outcome, result.tag % 2 ? JobOutcome::kConfirmed : JobOutcome::kCancelled);
  }
}

/// Its verdict would depend on how busy the machine is.
TEST_P(WithWorkers, AJobThatBoundsItsEffortHasNoTimeLimit) {
  class Bounded : public ScriptedJob {
   public:
    Bounded() : ScriptedJob(Ending::kConfirm, 30, milliseconds(2)) {}
    bool bounds_its_effort() const override { return true; }
  };
  ConfirmationQueue queue({.slice = milliseconds(1),
                           .slices_per_turn = 10,
                           .checkpoints_per_turn = 20,
                           .job_time_limit = 0.005});
  queue.LaunchThreads(GetParam());
  queue.Insert(0, std::make_unique<Bounded>(), 0);
  const auto results = Collect(&queue, GetParam(), 1);
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].outcome, JobOutcome::kConfirmed) << results[0].reason;
  EXPECT_GT(results[0].seconds, 0.005);
}

TEST_P(WithWorkers, AJobThatTakesTooLongFails) {
  ConfirmationQueue queue({.slice = milliseconds(1),
                           .slices_per_turn = 10,
                           .checkpoints_per_turn = 20,
                           .job_time_limit = 0.05});
  queue.LaunchThreads(GetParam());
  queue.Insert(0, Job(Ending::kNever, 0), 0);
  const auto results = Collect(&queue, GetParam(), 1);
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].outcome, JobOutcome::kFailed);
  EXPECT_EQ(results[0].reason.substr(0, 18), "no verdict after 0") << results[0].reason;
  EXPECT_GE(results[0].seconds, 0.05);
}

TEST_P(WithWorkers, TheSlowestJobFailsWhenTheThreadLimitIsReached) {
  ConfirmationQueue queue({.slice = milliseconds(1),
                           .slices_per_turn = 5,
                           .checkpoints_per_turn = 10,
                           .max_threads = 4});
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 8; ++tag) {
    queue.Insert(tag, Job(Ending::kNever, 0), tag);
  }
  queue.Insert(8, Job(Ending::kConfirm, 5, milliseconds(1)), 8);
  bool confirmed = false;
  for (const JobResult& result : Collect(&queue, GetParam(), 6)) {
    confirmed = confirmed || result.tag == 8;
    if (result.tag != 8) {
      EXPECT_EQ(result.outcome, JobOutcome::kFailed);
      EXPECT_NE(result.reason.find("gave way"), std::string::npos) << result.reason;
    }
  }
  EXPECT_TRUE(confirmed);
}

/// A job that counts its steps, the jobs of its kind that run at once, and the order of their
/// starts.
struct Tally {
  std::atomic<int> running = 0;
  std::atomic<int> most_running = 0;
  std::atomic<int> begun = 0;
};

class CountingJob : public ConfirmationJob {
 public:
  CountingJob(Tally* tally, std::atomic<int>* steps, std::atomic<int>* place, int last_step)
      : tally_(tally), steps_(steps), place_(place), last_step_(last_step) {}

  JobVerdict Run(JobControl* control) override {
    *place_ = tally_->begun++;
    while (*steps_ < last_step_ && control->Checkpoint() && !control->cancelled()) {
      const int now = ++tally_->running;
      tally_->most_running = std::max<int>(tally_->most_running, now);
      ++*steps_;
      std::this_thread::sleep_for(microseconds(200));
      --tally_->running;
    }
    return JobVerdict::kConfirmed;
  }

 private:
  Tally* tally_;
  std::atomic<int>* steps_;
  std::atomic<int>* place_;
  int last_step_;
};

class Counted : public WithWorkers {
 protected:
  static constexpr int kJobs = 12;

  void InsertAll(ConfirmationQueue* queue, const std::vector<double>& costs, int last_step) {
    for (int tag = 0; tag < kJobs; ++tag) {
      queue->Insert(tag,
                    std::make_unique<CountingJob>(&tally_, &steps_[tag], &place_[tag], last_step),
                    costs[tag]);
    }
  }

  Tally tally_;
  std::atomic<int> steps_[kJobs] = {};
  std::atomic<int> place_[kJobs] = {};
};
class CountedBeside : public Counted {};
class CountedOneByOne : public Counted {};
INSTANTIATE_TEST_SUITE_P(ConfirmationQueue, Counted, ::testing::Values(0, 1, 2));
INSTANTIATE_TEST_SUITE_P(ConfirmationQueue, CountedBeside, ::testing::Values(1, 2));
INSTANTIATE_TEST_SUITE_P(ConfirmationQueue, CountedOneByOne, ::testing::Values(0, 1));

TEST_P(Counted, NoMoreJobsRunThanThereAreWorkers) {
  ConfirmationQueue queue(
      {.slice = milliseconds(1), .slices_per_turn = 4, .checkpoints_per_turn = 20});
  queue.LaunchThreads(GetParam());
  InsertAll(&queue, std::vector<double>(kJobs, 0), 40);
  EXPECT_EQ(Collect(&queue, GetParam(), kJobs).size(), kJobs);
  EXPECT_EQ(tally_.most_running, std::max(GetParam(), 1));
}

TEST_P(CountedBeside, EveryJobGetsSlicesWhateverItsCost) {
  ConfirmationQueue queue({.slice = milliseconds(1), .slices_per_turn = 1000000});
  queue.LaunchThreads(GetParam());
  std::vector<double> costs(kJobs, 1);
  std::iota(costs.begin(), costs.end(), 1);
  costs.back() = std::numeric_limits<double>::infinity();
  InsertAll(&queue, costs, std::numeric_limits<int>::max());
  const auto all_had_a_few_slices = [&] {
    return std::all_of(std::begin(steps_), std::end(steps_),
                       [](const auto& steps) { return steps >= 8; });
  };
  const Deadline deadline(20);
  while (!all_had_a_few_slices() && !deadline.Passed()) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_TRUE(all_had_a_few_slices());
  queue.CancelAll({});
  // The two cheapest jobs per worker share all but one slice in eight.
  const int front = 2 * GetParam();
  const int of_front = std::accumulate(steps_, steps_ + front, 0);
  const int of_others = std::accumulate(steps_ + front, steps_ + kJobs, 0);
  EXPECT_GT(of_front, 2 * of_others);
}

TEST_P(Counted, EveryJobGetsATurn) {
  ConfirmationQueue queue(
      {.slice = milliseconds(1), .slices_per_turn = 2, .checkpoints_per_turn = 10});
  queue.LaunchThreads(GetParam());
  std::vector<double> costs(kJobs);
  std::iota(costs.begin(), costs.end(), 1);
  InsertAll(&queue, costs, std::numeric_limits<int>::max());
  Collect(&queue, GetParam(), 1, 0.5);
  for (const auto& steps : steps_) {
    EXPECT_GT(steps, 0);
  }
  queue.CancelAll({});
}

TEST_P(CountedOneByOne, JobsRunInOrderOfCost) {
  ConfirmationQueue queue({.slices_per_fair_slice = 1000000});
  std::vector<double> costs(kJobs);
  for (int tag = 0; tag < kJobs; ++tag) {
    costs[tag] = (tag * 5) % kJobs;
  }
  InsertAll(&queue, costs, 1);
  const int promoted = 7;
  queue.SetCost(promoted, -1);
  costs[promoted] = -1;
  queue.LaunchThreads(GetParam());
  ASSERT_EQ(Collect(&queue, GetParam(), kJobs).size(), kJobs);
  for (int tag = 0; tag < kJobs; ++tag) {
    const auto rank =
        std::count_if(costs.begin(), costs.end(), [&](double cost) { return cost < costs[tag]; });
    EXPECT_EQ(place_[tag], rank) << tag;
  }
}

/// The least time, s, of several attempts to cancel 20 endless jobs, since the machine may be busy.
double LeastTimeToCancel(int workers) {
  double least = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 5 && least >= 0.05; ++attempt) {
    ConfirmationQueue queue(
        {.slice = milliseconds(1), .slices_per_turn = 3, .checkpoints_per_turn = 6});
    queue.LaunchThreads(workers);
    for (int tag = 0; tag < 20; ++tag) {
      queue.Insert(tag, Job(Ending::kNever, 0), 0);
    }
    EXPECT_TRUE(Collect(&queue, workers, 1, 0.1).empty());
    const auto begin = Clock::now();
    queue.CancelAll({});
    least = std::min(least, SecondsSince(begin));
  }
  return least;
}

TEST_P(WithWorkers, CancellingEndsWithin50Milliseconds) {
  EXPECT_LT(LeastTimeToCancel(GetParam()), 0.05);
}

/// A job that spends its time in a routine with a pause, resume and cancel handle of its own.
class SteeredJob : public ConfirmationJob {
 public:
  SteeredJob(std::atomic<int>* steps, int last_step) : steps_(steps), last_step_(last_step) {}
  JobVerdict Run(JobControl* control) override {
    test::SteeredRoutine routine;
    const bool go_on = control->RunSteered(routine.Steering(), [&] {
      routine.Run([&] {
        control->Charge(1);
        return ++*steps_ < last_step_;
      });
    });
    return go_on ? JobVerdict::kConfirmed : JobVerdict::kRefuted;
  }

 private:
  std::atomic<int>* steps_;
  int last_step_;
};

TEST_P(WithWorkers, SteeredJobsRotateAndEndLikeOthers) {
  constexpr int kJobs = 6;
  std::atomic<int> steps[kJobs] = {};
  ConfirmationQueue queue(
      {.slice = milliseconds(3), .slices_per_turn = 3, .checkpoints_per_turn = 9});
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < kJobs; ++tag) {
    queue.Insert(tag, std::make_unique<SteeredJob>(&steps[tag], tag < 4 ? 1000000 : 30), tag);
  }
  const auto results = Collect(&queue, GetParam(), 2);
  ASSERT_EQ(results.size(), 2);
  for (const JobResult& result : results) {
    EXPECT_GE(result.tag, 4);
    EXPECT_EQ(result.outcome, JobOutcome::kConfirmed);
    EXPECT_GT(result.seconds, 0);
  }
  for (const auto& count : steps) {
    EXPECT_GT(count, 0);
  }
  queue.CancelAll({});
  for (const JobResult& result : queue.DrainFinished()) {
    EXPECT_EQ(result.outcome, JobOutcome::kCancelled);
  }
}

TEST(ConfirmationQueue, WithoutWorkersTurnsAreCountedInCheckpoints) {
  ConfirmationQueue queue({.checkpoints_per_turn = 10});
  // The last of 35 checkpoints is in the fourth turn, however long the steps take.
  queue.Insert(0, Job(Ending::kConfirm, 35), 0);
  queue.Insert(1, Job(Ending::kConfirm, 35, microseconds(500)), 0);
  std::vector<std::vector<int>> ended;
  for (int turn = 0; turn < 8; ++turn) {
    queue.RunTurn(Deadline(10));
    ended.emplace_back();
    for (const JobResult& result : queue.DrainFinished()) {
      ended.back().push_back(result.tag);
    }
  }
  EXPECT_EQ(ended, (std::vector<std::vector<int>>{{}, {}, {}, {}, {}, {}, {0}, {1}}));
}

TEST(ConfirmationQueue, AJobThatAsksMoreOftenGetsMoreCheckpointsInATurn) {
  class OftenAsking : public ScriptedJob {
   public:
    using ScriptedJob::ScriptedJob;
    double work_of_checkpoint() const override { return kWorkOfCheckpoint / 4; }
  };
  ConfirmationQueue queue({.checkpoints_per_turn = 10});
  queue.Insert(0, std::make_unique<OftenAsking>(Ending::kConfirm, 39), 0);
  EXPECT_TRUE(queue.RunTurn(Deadline(10)));
  queue.Insert(1, std::make_unique<OftenAsking>(Ending::kConfirm, 42), 0);
  EXPECT_FALSE(queue.RunTurn(Deadline(10)));
  EXPECT_TRUE(queue.RunTurn(Deadline(10)));
}

TEST(ConfirmationQueue, ATurnStopsAtTheDeadlineAndGoesOnLater) {
  ConfirmationQueue queue;
  queue.Insert(0, Job(Ending::kConfirm, 20, milliseconds(1)), 0);
  queue.RunTurn(Deadline(0.005));
  EXPECT_TRUE(queue.DrainFinished().empty());
  queue.RunTurn(Deadline(10));
  const auto results = queue.DrainFinished();
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].outcome, JobOutcome::kConfirmed);
}

TEST(ConfirmationQueue, AnythingThrownIsAFailure) {
  class Thrower : public ConfirmationJob {
    JobVerdict Run(JobControl*) override { throw 3; }
  };
  ConfirmationQueue queue;
  queue.Insert(0, std::make_unique<Thrower>(), 0);
  queue.RunTurn(Deadline(10));
  const auto results = queue.DrainFinished();
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].outcome, JobOutcome::kFailed);
  EXPECT_EQ(results[0].reason, "unknown exception");
}

TEST(ConfirmationQueue, SettingsMustBePositive) {
  const auto expect_throw = [](const ConfirmationQueue::Settings& settings) {
    EXPECT_THROW(ConfirmationQueue{settings}, std::invalid_argument);
  };
  expect_throw({.slice = milliseconds(0)});
  expect_throw({.slices_per_turn = 0});
  expect_throw({.checkpoints_per_turn = 0});
  expect_throw({.rotating_jobs_per_worker = 0});
  expect_throw({.slices_per_fair_slice = 0});
  expect_throw({.max_threads = 0});
  expect_throw({.job_time_limit = std::nan("")});
}

}  // namespace
}  // namespace possibility::graph
