#include "experiments/support/hardware_threads.h"

#include <algorithm>
#include <thread>

#include "common/blas_threads.h"

namespace possibility::experiments {

int HardwareThreads() {
  if (BlasIsForOneThread()) return 1;
  return static_cast<int>(
      std::clamp<unsigned>(std::thread::hardware_concurrency(), 1, kMaxThreads));
}

}  // namespace possibility::experiments
