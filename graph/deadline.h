#pragma once

#include <algorithm>
#include <chrono>

namespace possibility::graph {

/// A stretch of time that began with the object. Cheap enough to be asked in every loop.
class Deadline {
 public:
  /// `limit` in s; may be infinite.
  explicit Deadline(double limit) : limit_(limit) {}

  /// Time since the beginning, s.
  double Elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  bool Passed() const { return Elapsed() >= limit_; }

  /// Time to the end, s; 0 once it passed.
  double Remaining() const { return std::max(limit_ - Elapsed(), 0.0); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double limit_;
};

}  // namespace possibility::graph
