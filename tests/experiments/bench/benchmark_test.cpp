#include "experiments/bench/benchmark.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace possibility::experiments {
namespace {

TEST(BenchmarkTest, MedianOfOddAndEvenNumbers) {
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
  EXPECT_THROW(Median({}), std::invalid_argument);
}

TEST(BenchmarkTest, RatioPairsTheRounds) {
  BenchmarkReport report;
  // The machine was ten times slower in the second round. The ratio must not depend on that.
  report.rows = {{"slow", 0, {4, 40, 4}}, {"fast", 0, {2, 20, 2}}};
  EXPECT_EQ(report.Ratio("slow", "fast"), 2);
  EXPECT_THROW(report.Ratio("slow", "faster"), std::invalid_argument);
}

TEST(BenchmarkTest, TimesEveryCaseInEveryRound) {
  int rounds_seen = 0;
  int calls = 0;
  const auto rows = TimeInTurn({{"a", [&](int) { ++calls; }}, {"b", [](int) {}}}, 3, 1e-4,
                               [&](int round, int of) {
                                 EXPECT_EQ(round, ++rounds_seen);
                                 EXPECT_EQ(of, 3);
                               });
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].name, "a");
  EXPECT_EQ(rows[0].rounds.size(), 3U);
  EXPECT_GE(rows[1].microseconds, 0);
  EXPECT_EQ(rounds_seen, 3);
  EXPECT_GE(calls, 4);
}

TEST(BenchmarkTest, EachOfTwoThreadsGetsItsOwnWorker) {
  std::atomic<int> workers = 0;
  std::atomic<int> calls = 0;
  const auto worker = [&]() -> std::function<void(int)> {
    ++workers;
    return [&](int) { ++calls; };
  };
  EXPECT_GT(TwoThreadThroughput(worker, 10, 3), 0);
  EXPECT_EQ(workers, 1 + 3 * 2);
  EXPECT_EQ(calls, 3 * 3 * 10);
}

TEST(BenchmarkTest, JsonHasRowsAndRatiosByName) {
  BenchmarkReport report;
  report.rows = {{"inverse dynamics", 2.5, {}}};
  report.ratios = {{"speedup", 40, "theirs / ours"}};
  EXPECT_EQ(
      report.Json().dump(),
      R"({"rows":[{"name":"inverse dynamics","microseconds":2.5}],"ratios":{"speedup":40.0}})");
  EXPECT_NE(report.Text().find("theirs / ours"), std::string::npos);
}

}  // namespace
}  // namespace possibility::experiments
