#include "experiments/support/hardware_threads.h"

#include <algorithm>
#include <thread>

namespace possibility::experiments {

int HardwareThreads() {
  return static_cast<int>(
      std::clamp<unsigned>(std::thread::hardware_concurrency(), 1, kMaxThreads));
}

}  // namespace possibility::experiments
