#include "graph/confirmation_queue.h"

#include <exception>
#include <utility>

namespace possibility::graph {

ConfirmationQueue::ConfirmationQueue() : ConfirmationQueue(Settings()) {}

ConfirmationQueue::ConfirmationQueue(const Settings& settings) : settings_(settings) {}

ConfirmationQueue::~ConfirmationQueue() { Cancel(); }

void ConfirmationQueue::LaunchThreads(int count) {
  {
    const std::lock_guard lock(mutex_);
    rotation_limit_ = settings_.rotating_jobs_per_thread * count;
  }
  for (int i = 0; i < count; ++i) {
    threads_.emplace_back([this](const std::stop_token& stop) { Work(stop); });
  }
}

void ConfirmationQueue::Insert(int tag, std::unique_ptr<ConfirmationJob> job) {
  ++num_open_;
  const std::lock_guard lock(mutex_);
  waiting_.push_back({.tag = tag, .job = std::move(job)});
  FillRotation();
}

std::vector<JobResult> ConfirmationQueue::DrainFinished() {
  const std::lock_guard lock(mutex_);
  num_open_ -= static_cast<int>(finished_.size());
  return std::exchange(finished_, {});
}

void ConfirmationQueue::WaitForResult(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  result_.wait_for(lock, limit, [this] { return !finished_.empty(); });
}

void ConfirmationQueue::RunTurn(const std::function<bool()>& stop) {
  if (waiting_.empty()) {
    return;
  }
  Entry entry = std::move(waiting_.front());
  waiting_.pop_front();
  JobResult result;
  for (int i = 0; i < settings_.slices_per_turn && !stop(); ++i) {
    if (RunSlice(&entry, &result)) {
      finished_.push_back(std::move(result));
      return;
    }
  }
  waiting_.push_back(std::move(entry));
}

void ConfirmationQueue::Cancel() {
  for (std::jthread& thread : threads_) {
    thread.request_stop();
  }
  threads_.clear();
  rotation_limit_ = 0;
  waiting_.clear();
  rotation_.clear();
  finished_.clear();
  num_open_ = 0;
}

bool ConfirmationQueue::RunSlice(Entry* entry, JobResult* result) const {
  const auto begin = std::chrono::steady_clock::now();
  JobState state = JobState::kRunning;
  result->tag = entry->tag;
  result->outcome = JobOutcome::kFailed;
  bool ended = true;
  try {
    state = entry->job->Run(settings_.slice);
    ended = state != JobState::kRunning;
    if (state == JobState::kRefuted) {
      result->reason = entry->job->reason();
    }
    result->outcome = state == JobState::kConfirmed ? JobOutcome::kConfirmed : JobOutcome::kRefuted;
  } catch (const std::exception& error) {
    result->reason = error.what();
  } catch (...) {
    result->reason = "unknown exception";
  }
  ++entry->slices;
  entry->seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result->seconds = entry->seconds;
  return ended;
}

void ConfirmationQueue::Work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (work_or_stop_.wait(lock, stop, [this] { return !rotation_.empty(); }) &&
         !stop.stop_requested()) {
    Entry entry = TakeNext();
    lock.unlock();
    JobResult result;
    const bool ended = RunSlice(&entry, &result);
    if (ended) {
      entry.job.reset();
    }
    lock.lock();
    --num_running_;
    if (ended) {
      finished_.push_back(std::move(result));
      FillRotation();
      result_.notify_all();
    } else {
      PutBack(std::move(entry));
    }
  }
}

ConfirmationQueue::Entry ConfirmationQueue::TakeNext() {
  Entry entry = std::move(rotation_.front());
  rotation_.pop_front();
  ++num_running_;
  return entry;
}

void ConfirmationQueue::PutBack(Entry entry) {
  const bool turn_over = entry.slices % settings_.slices_per_turn == 0;
  if (turn_over && !waiting_.empty()) {
    waiting_.push_back(std::move(entry));
    FillRotation();
  } else {
    rotation_.push_back(std::move(entry));
    work_or_stop_.notify_one();
  }
}

void ConfirmationQueue::FillRotation() {
  while (!waiting_.empty() && static_cast<int>(rotation_.size()) + num_running_ < rotation_limit_) {
    rotation_.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
    work_or_stop_.notify_one();
  }
}

}  // namespace possibility::graph
