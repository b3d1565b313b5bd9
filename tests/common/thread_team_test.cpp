#include "common/thread_team.h"

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

TEST(ThreadTeam, EveryIndexIsCalledOnceEachTime) {
  for (const int threads : {0, 1, 2, 4}) {
    ThreadTeam team(threads);
    for (int repeat = 0; repeat < 300; ++repeat) {
      std::vector<std::atomic<int>> calls(static_cast<std::size_t>(repeat % 7));
      team.ForEach(calls.size(), [&](std::size_t i) { ++calls[i]; });
      for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
    }
  }
}

TEST(ThreadTeam, ItsThreadsHelpAndAreTheSameEachTime) {
  ThreadTeam team(3);
  std::mutex mutex;
  std::set<std::thread::id> ids;
  for (int repeat = 0; repeat < 20; ++repeat) {
    // Nobody can make all calls alone.
    std::atomic<int> begun = 0;
    team.ForEach(3, [&](std::size_t) {
      ++begun;
      while (begun < 3) std::this_thread::yield();
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(ids.size(), 3);
  EXPECT_TRUE(ids.contains(std::this_thread::get_id()));
}

TEST(ThreadTeam, TheExceptionOfTheLeastIndexIsThrownAndTheTeamGoesOn) {
  ThreadTeam team(4);
  for (int repeat = 0; repeat < 100; ++repeat) {
    try {
      team.ForEach(20, [](std::size_t i) {
        if (i % 3 == 2) throw std::runtime_error(std::to_string(i));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "2");
    }
    std::atomic<int> calls = 0;
    team.ForEach(5, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 5);
  }
}

}  // namespace
}  // namespace possibility
