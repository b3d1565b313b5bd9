#include "experiments/support/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace possibility::experiments {

PeakMemory::PeakMemory() {
  ::malloc_trim(0);
  // "5" resets the peak to the current resident size (proc(5), clear_refs).
  std::ofstream references("/proc/self/clear_refs");
  references << "5" << std::flush;
  is_reset_ = references.good();
}

double PeakMemory::megabytes() const {
  if (!is_reset_) return 0;
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    double kilobytes = 0;
    if (key == "VmHWM:" && status >> kilobytes) return kilobytes * 1024e-6;
  }
  return 0;
}

}  // namespace possibility::experiments
