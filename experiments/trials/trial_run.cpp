#include "experiments/trials/trial_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <exception>
#include <mutex>
#include <thread>

#include "experiments/report/plan_picture.h"
#include "experiments/report/plan_speeds.h"
#include "experiments/report/plan_summary.h"
#include "experiments/support/output_file.h"
#include "experiments/support/peak_memory.h"
#include "experiments/support/run_environment.h"
#include "experiments/support/standard_streams.h"

namespace possibility::experiments {
namespace {

TrialRecord RecordOf(const TrialTask& task, const actions::PlanResult& result) {
  TrialRecord record;
  record.key = task.key;
  record.identity = task.identity;
  record.parameter = task.parameter;
  record.value = task.value;
  record.success = result.status == actions::PlanStatus::kFound;
  record.verified = record.success && result.verification.accepted();
  record.timings = result.plan.timings;
  record.counters = result.plan.statistics;
  record.machine = ThisEnvironment().cpu;
  if (record.success) {
    record.real_time_ratio = RealTimeRatio(result.plan);
    record.plan_duration = result.plan.duration();
    record.length = PlanarLength(result.plan);
    record.plan_hash = MotionHash(result.plan);
    if (result.plan.search) {
      record.explorers = fmt::format("{}", fmt::join(result.plan.search->explorers, ", "));
    }
  } else {
    record.no = actions::ToString(result.status);
  }
  return record;
}

/// Pool of trials for several threads.
class TrialPool {
 public:
  TrialPool(const std::vector<TrialTask>& tasks, ResultsFile* results,
            const TrialProgress& progress)
      : tasks_(tasks), results_(results), progress_(progress) {}

  void Work() {
    while (const TrialTask* task = Take()) {
      try {
        results_->Append(RunTrial(*task));
        const std::lock_guard lock(mutex_);
        ++done_;
        if (progress_) progress_(done_, tasks_.size());
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
      }
    }
  }

  void RethrowError() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  const TrialTask* Take() {
    const std::lock_guard lock(mutex_);
    return error_ || next_ == tasks_.size() ? nullptr : &tasks_[next_++];
  }

  const std::vector<TrialTask>& tasks_;
  ResultsFile* results_;
  const TrialProgress& progress_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

TrialRecord RunTrial(const TrialTask& task) {
  const std::shared_ptr<const models::Scenario> scenario = task.scenario();
  actions::PlanRequest request = task.request;
  request.seed = task.key.seed;
  request.time_limit = task.time_limit.value_or(scenario->time_limit);
  const PeakMemory memory;
  const actions::PlanResult result = actions::PlanTraversal(*task.robot, *scenario, request);
  if (!task.picture.empty()) {
    WriteOutput(task.picture, PlanPicture(result.plan, scenario->environment));
  }
  TrialRecord record = RecordOf(task, result);
  record.memory_mb = memory.megabytes();
  return record;
}

void RunTrials(const std::vector<TrialTask>& tasks, int threads, ResultsFile* results,
               const TrialProgress& progress) {
  TrialPool pool(tasks, results, progress);
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads && i < static_cast<int>(tasks.size()); ++i) {
      workers.emplace_back([&pool] { pool.Work(); });
    }
  }
  pool.RethrowError();
}

std::string DescribeTrials(std::size_t done, std::size_t all, double elapsed_s) {
  std::string line = fmt::format("trial {} of {}", done, all);
  if (done == 0 || done == all) return line;
  const double left = elapsed_s / static_cast<double>(done) * static_cast<double>(all - done);
  const auto seconds = static_cast<long long>(left + 0.5);
  return line + fmt::format(", {}:{:02} left", seconds / 60, seconds % 60);
}

TrialProgressLine::TrialProgressLine() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

TrialProgressLine::~TrialProgressLine() {
  if (is_terminal_) std::fputs("\r\033[K", stderr);
}

void TrialProgressLine::Show(std::size_t done, std::size_t all) const {
  if (!is_terminal_) return;
  PrintError("\r\033[K{}", DescribeTrials(done, all, stopwatch_.Seconds()));
}

}  // namespace possibility::experiments
