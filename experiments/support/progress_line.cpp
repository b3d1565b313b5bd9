#include "experiments/support/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace possibility::experiments {
namespace {

/// Carriage return, then "erase to the end of the line" (ECMA-48, EL).
constexpr const char* kRestartLine = "\r\033[K";

}  // namespace

std::string DescribeProgress(const actions::PlanProgress& progress, double elapsed_s,
                             double time_limit_s) {
  std::string line = progress.stage;
  if (progress.fraction > 0) line += fmt::format(" {:.0f} %", 100 * progress.fraction);
  if (progress.graph.vertices > 0) {
    line += fmt::format("  {} vertices  {} edges  {} jobs", progress.graph.vertices,
                        progress.graph.edges, progress.graph.jobs);
  }
  if (progress.graph.best_route_seconds > 0) {
    line += fmt::format("  best route {:.0f} s", progress.graph.best_route_seconds);
  }
  return line + fmt::format("  {:.1f} / {:.0f} s", elapsed_s, time_limit_s);
}

ProgressLine::ProgressLine(double time_limit_s)
    : is_terminal_(::isatty(STDERR_FILENO) == 1), time_limit_s_(time_limit_s) {}

ProgressLine::~ProgressLine() {
  if (is_terminal_) std::fputs(kRestartLine, stderr);
}

void ProgressLine::Show(const actions::PlanProgress& progress) {
  if (!is_terminal_) return;
  const std::string line = DescribeProgress(progress, stopwatch_.Seconds(), time_limit_s_);
  std::fputs((kRestartLine + line).c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace possibility::experiments
