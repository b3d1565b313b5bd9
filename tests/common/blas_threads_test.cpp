#include "common/blas_threads.h"

#include <gtest/gtest.h>

namespace possibility {
namespace {

// Descriptions as OpenBLAS 0.3.21 of Debian 12 gives them.
TEST(BlasThreads, OpenBlasWithoutThreadsAndLocksIsForOneThread) {
  EXPECT_TRUE(IsForOneThread(
      "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH NO_AFFINITY Haswell SINGLE_THREADED"));
  EXPECT_FALSE(
      IsForOneThread("OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH NO_AFFINITY Haswell MAX_THREADS=64"));
  EXPECT_FALSE(IsForOneThread(
      "OpenBLAS 0.3.21 NO_LAPACKE DYNAMIC_ARCH USE_LOCKING NO_AFFINITY Haswell SINGLE_THREADED"));
}

}  // namespace
}  // namespace possibility
