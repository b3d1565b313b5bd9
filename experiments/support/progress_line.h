#pragma once

#include <string>

#include "actions/planner/planner.h"
#include "common/stopwatch.h"

namespace possibility::experiments {

/// State of the planner in one line: "exploring 1204 vertices ...".
std::string DescribeProgress(const actions::PlanProgress& progress, double elapsed_s,
                             double time_limit_s);

/// A line on stderr that is rewritten while the planner works; silent if stderr is not a terminal.
/// Erased by the destructor.
class ProgressLine {
 public:
  explicit ProgressLine(double time_limit_s);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void Show(const actions::PlanProgress& progress);

 private:
  bool is_terminal_;
  double time_limit_s_;
  Stopwatch stopwatch_;
};

}  // namespace possibility::experiments
