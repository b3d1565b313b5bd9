#pragma once

namespace possibility::experiments {

/// The most memory this process has held since the object was made, all of its threads together.
class PeakMemory {
 public:
  /// Gives freed memory back to the system first, so that what came before does not count.
  PeakMemory();

  /// Resident, MB (10^6 bytes); 0 where the system does not tell, or resets no peaks.
  double megabytes() const;

 private:
  bool is_reset_ = false;
};

}  // namespace possibility::experiments
