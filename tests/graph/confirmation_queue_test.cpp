#include "graph/confirmation_queue.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/graph/scripted_job.h"

namespace possibility::graph {
namespace {

using std::chrono::milliseconds;
using test::Ending;
using test::ScriptedJob;

constexpr auto kNeverStop = [] { return false; };

/// Runs the queue until `count` results came, at most 5 s.
std::vector<JobResult> Collect(ConfirmationQueue* queue, int threads, std::size_t count) {
  std::vector<JobResult> all;
  const auto begin = std::chrono::steady_clock::now();
  while (all.size() < count && std::chrono::steady_clock::now() - begin < std::chrono::seconds(5)) {
    if (threads == 0) {
      queue->RunTurn(kNeverStop);
    } else {
      queue->WaitForResult(milliseconds(20));
    }
    for (JobResult& result : queue->DrainFinished()) {
      all.push_back(std::move(result));
    }
  }
  return all;
}

class WithThreads : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(ConfirmationQueue, WithThreads, ::testing::Values(0, 1, 2));

TEST_P(WithThreads, EveryJobComesToItsOwnEnd) {
  ConfirmationQueue queue({.slice = milliseconds(1), .slices_per_turn = 3});
  queue.LaunchThreads(GetParam());
  const std::vector<Ending> endings = {Ending::kConfirm, Ending::kRefute, Ending::kThrow};
  for (int tag = 0; tag < 60; ++tag) {
    queue.Insert(tag, std::make_unique<ScriptedJob>(endings[tag % 3], 1 + tag % 10));
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
                                   JobOutcome::kFailed};
    const char* reasons[] = {"", "torque limit", "solver broke down"};
    EXPECT_EQ(result.outcome, expected[tag % 3]);
    EXPECT_EQ(result.reason, reasons[tag % 3]);
  }
}

TEST_P(WithThreads, EasyJobsEndBesideEndlessOnes) {
  ConfirmationQueue queue({.slice = milliseconds(1), .slices_per_turn = 5});
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 8; ++tag) {
    queue.Insert(tag, std::make_unique<ScriptedJob>(Ending::kNever, 0, milliseconds(1)));
  }
  queue.Insert(8, std::make_unique<ScriptedJob>(Ending::kConfirm, 12, milliseconds(1)));
  const auto results = Collect(&queue, GetParam(), 1);
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].tag, 8);
  EXPECT_GT(results[0].seconds, 0.011);
}

TEST_P(WithThreads, CancelDropsEverythingAndEndsTheThreads) {
  ConfirmationQueue queue;
  queue.LaunchThreads(GetParam());
  for (int tag = 0; tag < 50; ++tag) {
    queue.Insert(tag, std::make_unique<ScriptedJob>(Ending::kNever, 0, milliseconds(1)));
  }
  queue.WaitForResult(milliseconds(20));
  queue.Cancel();
  EXPECT_EQ(queue.num_open(), 0);
  EXPECT_TRUE(queue.DrainFinished().empty());
}

TEST(ConfirmationQueue, ATurnStopsBetweenSlicesAndGoesOnLater) {
  ConfirmationQueue queue;
  queue.Insert(0, std::make_unique<ScriptedJob>(Ending::kConfirm, 10));
  int asked = 0;
  queue.RunTurn([&] { return ++asked > 4; });
  EXPECT_TRUE(queue.DrainFinished().empty());
  queue.RunTurn(kNeverStop);
  EXPECT_EQ(queue.DrainFinished().size(), 1);
}

TEST(ConfirmationQueue, AnythingThrownIsAFailure) {
  class Thrower : public ConfirmationJob {
    JobState Run(milliseconds) override { throw 3; }
  };
  ConfirmationQueue queue;
  queue.Insert(0, std::make_unique<Thrower>());
  queue.RunTurn(kNeverStop);
  const auto results = queue.DrainFinished();
  ASSERT_EQ(results.size(), 1);
  EXPECT_EQ(results[0].outcome, JobOutcome::kFailed);
  EXPECT_EQ(results[0].reason, "unknown exception");
}

}  // namespace
}  // namespace possibility::graph
