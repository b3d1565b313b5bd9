#include "common/run_on_threads.h"

#include <gtest/gtest.h>

#include <mutex>
#include <set>
#include <thread>

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

}  // namespace
}  // namespace possibility
