#pragma once

#include <algorithm>
#include <chrono>

namespace possibility::graph {

/// A time limit that starts at construction. Cheap enough to query in every loop.
class Deadline {
 public:
  /// `limit` in s; may be infinite.
  explicit Deadline(double limit) : limit_(limit) {}

  /// Time since construction, s.
  double Elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  bool Passed() const { return Elapsed() >= limit_; }

  /// Remaining time, s; 0 once the deadline has passed.
  double Remaining() const { return std::max(limit_ - Elapsed(), 0.0); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double limit_;
};

}  // namespace possibility::graph
