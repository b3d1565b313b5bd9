#include "graph/confirmation/confirmation_queue.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace possibility::graph {
namespace {

using Clock = QueuedJob::Clock;
using Seconds = std::chrono::duration<double>;
using State = QueuedJob::State;

/// Longer than any wait. Waiting for infinity would overflow the clock.
constexpr double kForever = 1e6;  // s

}  // namespace

ConfirmationQueue::ConfirmationQueue() : ConfirmationQueue(Settings()) {}

ConfirmationQueue::ConfirmationQueue(const Settings& settings) : settings_(settings) {
  if (settings.slice.count() < 1 || settings.slices_per_turn < 1 ||
      settings.checkpoints_per_turn < 1 || settings.rotating_jobs_per_worker < 1 ||
      settings.slices_per_fair_slice < 1 || settings.max_threads < 1 ||
      !(settings.job_time_limit > 0)) {
    throw std::invalid_argument("ConfirmationQueue: expected every setting to be positive");
  }
}

ConfirmationQueue::~ConfirmationQueue() { CancelAll({}); }

void ConfirmationQueue::LaunchThreads(int workers) {
  workers_ = workers;
  if (workers > 0) {
    dispatcher_ = std::jthread([this](const std::stop_token& stop) {
      std::unique_lock lock(mutex_);
      Dispatch(stop, &lock);
    });
  }
}

void ConfirmationQueue::Insert(int tag, std::unique_ptr<ConfirmationJob> job, double cost) {
  ++num_open_;
  const std::lock_guard lock(mutex_);
  jobs_.push_back(std::make_unique<QueuedJob>(tag, std::move(job), cost,
                                              [this](QueuedJob* held) { OnHeld(held); }));
  jobs_.back()->last_served = grants_;
  Notify();
}

void ConfirmationQueue::SetCost(int tag, double cost) {
  const std::lock_guard lock(mutex_);
  if (QueuedJob* job = Find(tag)) {
    job->cost = cost;
  }
}

void ConfirmationQueue::Cancel(int tag, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (QueuedJob* job = Find(tag)) {
    job->Overrule(JobOutcome::kCancelled, reason);
    Notify();
  }
}

std::vector<JobResult> ConfirmationQueue::DrainFinished() {
  const std::lock_guard lock(mutex_);
  Reap();
  num_open_ -= static_cast<int>(finished_.size());
  return std::exchange(finished_, {});
}

void ConfirmationQueue::WaitForResult(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  result_.wait_for(lock, limit, [this] { return !finished_.empty(); });
}

bool ConfirmationQueue::RunTurn(const Deadline& deadline, int length) {
  std::unique_lock lock(mutex_);
  const auto wait_for = [&](double seconds, auto done) {
    event_.wait_for(lock, Seconds(std::min({seconds, deadline.Remaining(), kForever})), done);
  };
  wait_for(kForever, [this] { return NumWithState(State::kRunning, State::kPausing) == 0; });
  Reap();
  QueuedJob* job = PickNext(jobs_, settings_, 1, grants_);
  if (job == nullptr || !Grant(job, CheckpointsOfTurn(*job, length))) {
    return true;
  }
  const auto has_stopped = [job] {
    return job->state == State::kEnded || job->state == State::kPaused;
  };
  wait_for(TimeLeft(*job), has_stopped);
  if (!has_stopped()) {
    EndSlice(job);
    wait_for(kForever, has_stopped);
  }
  const bool ended = job->state == State::kEnded;
  job->slices += length * settings_.slices_per_turn;
  Reap();
  return ended;
}

void ConfirmationQueue::CancelAll(const std::string& reason) {
  dispatcher_ = std::jthread();
  std::unique_lock lock(mutex_);
  workers_ = 0;
  for (const auto& job : jobs_) {
    job->Overrule(JobOutcome::kCancelled, reason);
  }
  event_.wait(lock, [this] {
    return std::all_of(jobs_.begin(), jobs_.end(),
                       [](const auto& job) { return job->state == State::kEnded; });
  });
  Reap();
}

void ConfirmationQueue::RunJob(QueuedJob* job) {
  JobResult result = Examine(job->job.get(), &job->control);
  job->job.reset();
  const std::lock_guard lock(mutex_);
  job->AddUp();
  job->result = std::move(result);
  job->state = State::kEnded;
  Notify();
}

void ConfirmationQueue::OnHeld(QueuedJob* job) {
  const std::lock_guard lock(mutex_);
  job->AddUp();
  job->state = State::kPaused;
  Notify();
}

void ConfirmationQueue::Dispatch(const std::stop_token& stop, std::unique_lock<std::mutex>* lock) {
  while (!stop.stop_requested()) {
    news_ = false;
    Reap();
    EndSlices();
    GrantPermits();
    if (const auto slice_end = NextSliceEnd()) {
      event_.wait_until(*lock, stop, *slice_end, [this] { return news_; });
    } else {
      event_.wait(*lock, stop, [this] { return news_; });
    }
  }
}

void ConfirmationQueue::EndSlices() {
  const Clock::time_point now = Clock::now();
  for (const auto& job : jobs_) {
    if (job->state == State::kRunning && now - job->slice_begin >= settings_.slice) {
      EndSlice(job.get());
    }
  }
}

void ConfirmationQueue::EndSlice(QueuedJob* job) {
  job->AddUp();
  ++job->slices;
  const bool somebody_waits = NumWithState(State::kWaiting, State::kPaused) > 0;
  if (TimeLeft(*job) <= 0) {
    job->Overrule(JobOutcome::kFailed, NoVerdictAfter(job->seconds, ""));
  } else if ((somebody_waits || workers_ == 0) && !job->overruling) {
    job->state = State::kPausing;
    if (job->control.Pause()) {
      job->state = State::kPaused;
    }
  }
}

void ConfirmationQueue::GrantPermits() {
  while (NumWithState(State::kRunning, State::kPausing) < workers_) {
    QueuedJob* next =
        PickNext(jobs_, settings_, settings_.rotating_jobs_per_worker * workers_, grants_);
    if (next == nullptr) {
      return;
    }
    Grant(next);
  }
}

bool ConfirmationQueue::Grant(QueuedJob* job, std::optional<std::int64_t> checkpoints) {
  const bool begins = job->state == State::kWaiting;
  job->last_served = ++grants_;
  job->slice_begin = Clock::now();
  job->state = State::kRunning;
  if (checkpoints) {
    job->control.Ration(*checkpoints);
  }
  if (!begins) {
    job->control.Resume();
    return true;
  }
  try {
    job->thread = std::thread([this, job] { RunJob(job); });
  } catch (const std::system_error& error) {
    job->result.reason = error.what();
    job->state = State::kEnded;
    Notify();
    return false;
  }
  return true;
}

void ConfirmationQueue::Reap() {
  const auto has_ended = [](const auto& job) { return job->state == State::kEnded; };
  for (const auto& job : jobs_) {
    if (has_ended(job)) {
      finished_.push_back(job->TakeResult());
    }
  }
  if (std::erase_if(jobs_, has_ended) > 0) {
    result_.notify_all();
  }
}

double ConfirmationQueue::TimeLeft(const QueuedJob& job) const {
  return job.bounds_its_effort ? kForever : settings_.job_time_limit - job.seconds;
}

std::int64_t ConfirmationQueue::CheckpointsOfTurn(const QueuedJob& job, int length) const {
  const double share = ConfirmationJob::kWorkOfCheckpoint / job.work_of_checkpoint;
  const double checkpoints = std::round(length * settings_.checkpoints_per_turn * share);
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(checkpoints));
}

int ConfirmationQueue::NumWithState(State a, State b) const {
  return static_cast<int>(std::count_if(jobs_.begin(), jobs_.end(), [=](const auto& job) {
    return job->state == a || job->state == b;
  }));
}

std::optional<Clock::time_point> ConfirmationQueue::NextSliceEnd() const {
  std::optional<Clock::time_point> next;
  for (const auto& job : jobs_) {
    if (job->state == State::kRunning && !job->overruling) {
      const Clock::time_point end = job->slice_begin + settings_.slice;
      next = next ? std::min(*next, end) : end;
    }
  }
  return next;
}

QueuedJob* ConfirmationQueue::Find(int tag) const {
  const auto found =
      std::find_if(jobs_.begin(), jobs_.end(), [tag](const auto& job) { return job->tag == tag; });
  return found == jobs_.end() ? nullptr : found->get();
}

void ConfirmationQueue::Notify() {
  news_ = true;
  event_.notify_all();
}

}  // namespace possibility::graph
