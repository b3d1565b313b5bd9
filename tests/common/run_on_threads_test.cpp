#include "common/run_on_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace possibility {
namespace {

TEST(RunOnThreads, EveryThreadDoesTheWorkOnceTheCallersIncluded) {
  for (const int threads : {1, 2, 5}) {
    std::mutex mutex;
    std::set<std::thread::id> ids;
    int calls = 0;
    RunOnThreads(threads, [&] {
      const std::lock_guard lock(mutex);
      ++calls;
      ids.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(calls, threads);
    EXPECT_TRUE(ids.contains(std::this_thread::get_id()));
  }
}

TEST(ForEachOnThreads, EveryIndexIsCalledOnce) {
  for (const int threads : {0, 1, 3, 100}) {
    std::vector<std::atomic<int>> calls(50);
    ForEachOnThreads(threads, calls.size(), [&](std::size_t i) { ++calls[i]; });
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  }
  ForEachOnThreads(4, 0, [](std::size_t) { FAIL(); });
}

TEST(ForEachOnThreads, TheExceptionOfTheLeastIndexIsThrown) {
  for (int repeat = 0; repeat < 50; ++repeat) {
    try {
      ForEachOnThreads(4, 40, [](std::size_t i) {
        if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "7");
    }
  }
}

}  // namespace
}  // namespace possibility
