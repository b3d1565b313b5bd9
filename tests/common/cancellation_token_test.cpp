#include "common/cancellation_token.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <limits>
#include <thread>

namespace possibility {
namespace {

TEST(CancellationToken, WithoutASourceNeverCancels) {
  const CancellationToken token;
  EXPECT_TRUE(token.Proceed());
  EXPECT_NO_THROW(token.ThrowIfCancelled());
  EXPECT_TRUE(CancellationToken(std::function<bool()>()).Proceed());
}

TEST(CancellationToken, AFunctionIsAskedEveryTime) {
  int asked = 0;
  const CancellationToken token([&asked] { return ++asked < 3; });
  EXPECT_TRUE(token.Proceed());
  EXPECT_NO_THROW(token.ThrowIfCancelled());
  EXPECT_THROW(token.ThrowIfCancelled(), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(CancellationToken, CopiesAskTheSameSource) {
  int asked = 0;
  const CancellationToken token([&asked] { return ++asked < 2; });
  const CancellationToken copy = token;
  EXPECT_TRUE(copy.Proceed());
  EXPECT_FALSE(token.Proceed());
}

TEST(CancellationToken, ADeadlineIsCopiedAndCancelsOncePassed) {
  CancellationToken token;
  {
    const Deadline deadline(0.02);
    token = CancellationToken(deadline);
    EXPECT_TRUE(CancellationToken(Deadline(std::numeric_limits<double>::infinity())).Proceed());
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_FALSE(token.Proceed());
  EXPECT_FALSE(CancellationToken(Deadline(0)).Proceed());
}

}  // namespace
}  // namespace possibility
