#pragma once

#include <chrono>

namespace possibility {

/// Wall time since construction. Any thread may read it.
class Stopwatch {
 public:
  /// Time since construction, s.
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace possibility
