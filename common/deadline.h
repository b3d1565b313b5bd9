#pragma once

#include <algorithm>

#include "common/stopwatch.h"

namespace possibility {

/// A time limit that starts at construction. Cheap enough to query in every loop.
class Deadline {
 public:
  /// `limit` in s; may be infinite.
  explicit Deadline(double limit) : limit_(limit) {}

  /// Time since construction, s.
  double Elapsed() const { return stopwatch_.Seconds(); }

  bool Passed() const { return Elapsed() >= limit_; }

  /// Remaining time, s; 0 once the deadline has passed.
  double Remaining() const { return std::max(limit_ - Elapsed(), 0.0); }

 private:
  Stopwatch stopwatch_;
  double limit_;
};

}  // namespace possibility
