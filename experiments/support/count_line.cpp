#include "experiments/support/count_line.h"

#include <unistd.h>

#include "experiments/support/standard_streams.h"

namespace possibility::experiments {

void CountLine::Show(int done, int all) const {
  if (isatty(STDERR_FILENO) == 0) return;
  const int left = static_cast<int>(stopwatch_.Seconds() / done * (all - done));
  PrintError("\r{} {} of {}  {}:{:02} left {}", noun_, done, all, left / 60, left % 60,
             done == all ? "\r\x1b[K" : "");
}

}  // namespace possibility::experiments
