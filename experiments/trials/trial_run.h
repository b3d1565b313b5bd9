#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "common/stopwatch.h"
#include "experiments/trials/results_file.h"
#include "experiments/trials/trial_record.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// A trial to run.
struct TrialTask {
  TrialKey key;
  TrialIdentity identity;
  std::string parameter;  ///< of a sweep; empty: none
  double value = 0;
  std::shared_ptr<const models::RobotModel> robot;
  /// Called once, by the thread that runs the trial.
  std::function<std::shared_ptr<const models::Scenario>()> scenario;
  actions::PlanRequest request;      ///< without seed and time limit
  std::optional<double> time_limit;  ///< s; none: the scenario's
  std::filesystem::path picture;     ///< picture of the plan; empty: none
};

/// Plans once; writes the picture even if there is no plan.
/// @throws InputError as PlanTraversal; exceptions of `scenario` pass through.
TrialRecord RunTrial(const TrialTask& task);

/// Called after every trial, one call at a time, with the numbers of trials done and in all.
using TrialProgress = std::function<void(std::size_t, std::size_t)>;

/// Runs trials in order, `threads` at a time, and adds each to `results` as it ends.
/// @throws the exception of the first failed trial, after the running trials have ended.
void RunTrials(const std::vector<TrialTask>& tasks, int threads, ResultsFile* results,
               const TrialProgress& progress);

/// "trial 12 of 400, 1:20 left": a line on stderr that is rewritten, if stderr is a terminal.
/// Erased by the destructor.
class TrialProgressLine {
 public:
  TrialProgressLine();
  ~TrialProgressLine();
  TrialProgressLine(const TrialProgressLine&) = delete;
  TrialProgressLine& operator=(const TrialProgressLine&) = delete;

  void Show(std::size_t done, std::size_t all) const;

 private:
  bool is_terminal_;
  Stopwatch stopwatch_;
};

/// Text of that line after `elapsed_s`.
std::string DescribeTrials(std::size_t done, std::size_t all, double elapsed_s);

}  // namespace possibility::experiments
