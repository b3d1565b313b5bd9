#include "common/deadline.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <thread>

namespace possibility {
namespace {

TEST(Stopwatch, MeasuresAtLeastTheTimeSlept) {
  const Stopwatch stopwatch;
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const double seconds = stopwatch.Seconds();
  EXPECT_GE(seconds, 0.01);
  EXPECT_GE(stopwatch.Seconds(), seconds);
}

TEST(Deadline, PassesAfterItsTimeAndHasNoTimeLeftThen) {
  const Deadline deadline(0.01);
  EXPECT_LE(deadline.Remaining(), 0.01);
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(deadline.Passed());
  EXPECT_EQ(deadline.Remaining(), 0);
}

TEST(Deadline, AnInfiniteOneNeverPasses) {
  const Deadline deadline(std::numeric_limits<double>::infinity());
  EXPECT_FALSE(deadline.Passed());
  EXPECT_EQ(deadline.Remaining(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace possibility
