#pragma once

#include <string>

#include "common/stopwatch.h"

namespace possibility::experiments {

/// The line "jump 12 of 105  1:20 left" on stderr, rewritten while work is done and erased at its
/// end; silent if stderr is not a terminal.
class CountLine {
 public:
  /// `noun`: what is counted.
  explicit CountLine(std::string noun) : noun_(std::move(noun)) {}

  /// One call at a time. `done`: at least 1.
  void Show(int done, int all) const;

 private:
  std::string noun_;
  Stopwatch stopwatch_;
};

}  // namespace possibility::experiments
