#pragma once

namespace possibility::experiments {

/// Peak memory of this process since the object was constructed, all threads together.
class PeakMemory {
 public:
  /// Returns freed memory to the system first, so that earlier use does not count.
  PeakMemory();

  /// Resident, MB (10^6 bytes); 0 if the system does not report it or cannot reset the peak.
  double megabytes() const;

 private:
  bool is_reset_ = false;
};

}  // namespace possibility::experiments
