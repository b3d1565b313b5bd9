#include "graph/confirmation/queued_job.h"

#include <exception>
#include <sstream>
#include <utility>

namespace possibility::graph {

QueuedJob::QueuedJob(int tag_in, std::unique_ptr<ConfirmationJob> job_in, double cost_in,
                     std::function<void(QueuedJob*)> on_held)
    : tag(tag_in),
      cost(cost_in),
      work_of_checkpoint(job_in->work_of_checkpoint()),
      bounds_its_effort(job_in->bounds_its_effort()),
      job(std::move(job_in)),
      control([this, on_held = std::move(on_held)] { on_held(this); }) {}

void QueuedJob::AddUp() {
  if (state == State::kRunning || state == State::kPausing) {
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - slice_begin).count();
    slice_begin = now;
  }
}

void QueuedJob::Overrule(JobOutcome outcome, const std::string& reason) {
  if (state == State::kEnded || overruling) {
    return;
  }
  overruling = {outcome, reason};
  control.Cancel();
  if (state == State::kWaiting) {
    state = State::kEnded;
  }
}

JobResult QueuedJob::TakeResult() {
  if (thread.joinable()) {
    thread.join();
  }
  JobResult taken = std::move(result);
  if (overruling) {
    taken.outcome = overruling->outcome;
    taken.reason = std::move(overruling->reason);
  }
  taken.tag = tag;
  taken.seconds = seconds;
  return taken;
}

JobResult Examine(ConfirmationJob* job, JobControl* control) {
  JobResult result;
  try {
    switch (job->Run(control)) {
      case JobVerdict::kConfirmed:
        result.outcome = JobOutcome::kConfirmed;
        return result;
      case JobVerdict::kRefuted:
        result.outcome = JobOutcome::kRefuted;
        result.reason = job->reason();
        return result;
      case JobVerdict::kUndecided:
        result.reason = job->reason();
        if (result.reason.empty()) {
          result.reason = "the job could not tell";
        }
        return result;
    }
    result.reason = "the job returned no verdict that there is";
  } catch (const std::exception& error) {
    result.outcome = JobOutcome::kFailed;
    result.reason = error.what();
  } catch (...) {
    result.outcome = JobOutcome::kFailed;
    result.reason = "unknown exception";
  }
  return result;
}

std::string NoVerdictAfter(double seconds, const std::string& why) {
  std::ostringstream text;
  text.precision(3);
  text << "no verdict after " << seconds << " s" << why;
  return text.str();
}

}  // namespace possibility::graph
