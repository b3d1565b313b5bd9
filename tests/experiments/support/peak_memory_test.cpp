#include "experiments/support/peak_memory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <vector>

namespace possibility::experiments {
namespace {

// Sanitizers allocate memory of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

constexpr std::size_t kBytes = 200'000'000;

/// The memory is written to, otherwise the system would not provide any.
void UseMuch() {
  std::vector<char> much(kBytes, 1);
  volatile char last = much.back();
  static_cast<void>(last);
}

TEST(PeakMemory, CountsFreedMemoryButNoMemoryFromBefore) {
  const double before = PeakMemory().megabytes();
  if (!std::ofstream("/proc/self/clear_refs")) {
    EXPECT_EQ(before, 0) << "the system resets no peaks";
    return;
  }
  EXPECT_GT(before, 1);
  const PeakMemory memory;
  UseMuch();
  EXPECT_NEAR(memory.megabytes() - before, kBytes * 1e-6, 20);
  EXPECT_LT(PeakMemory().megabytes(), before + 20);
}

#endif

}  // namespace
}  // namespace possibility::experiments
