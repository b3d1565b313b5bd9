#include "graph/confirmation_queue.h"

#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace possibility::graph {
namespace {

using Seconds = std::chrono::duration<double>;

/// Longer than any wait; waiting for infinity itself would overflow the clock.
constexpr double kForever = 1e6;  // s

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

}  // namespace

ConfirmationQueue::Entry::Entry(ConfirmationQueue* queue, int tag_in,
                                std::unique_ptr<ConfirmationJob> job_in, double cost_in)
    : tag(tag_in),
      cost(cost_in),
      job(std::move(job_in)),
      control([queue, this] { queue->OnHeld(this); }) {}

ConfirmationQueue::ConfirmationQueue() : ConfirmationQueue(Settings()) {}

ConfirmationQueue::ConfirmationQueue(const Settings& settings) : settings_(settings) {
  if (settings.slice.count() < 1 || settings.slices_per_turn < 1 ||
      settings.rotating_jobs_per_worker < 1 || settings.slices_per_fair_slice < 1 ||
      settings.max_threads < 1 || !(settings.job_time_limit > 0)) {
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
  entries_.push_back(std::make_unique<Entry>(this, tag, std::move(job), cost));
  entries_.back()->last_served = grants_;
  Notify();
}

void ConfirmationQueue::SetCost(int tag, double cost) {
  const std::lock_guard lock(mutex_);
  if (Entry* entry = Find(tag)) {
    entry->cost = cost;
  }
}

void ConfirmationQueue::Cancel(int tag, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (Entry* entry = Find(tag)) {
    Overrule(entry, JobOutcome::kCancelled, reason);
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

bool ConfirmationQueue::RunTurn(const Deadline& deadline) {
  std::unique_lock lock(mutex_);
  const auto wait_for = [&](double seconds, auto done) {
    event_.wait_for(lock, Seconds(std::min({seconds, deadline.Remaining(), kForever})), done);
  };
  wait_for(kForever, [this] { return NumWithState(State::kRunning, State::kPausing) == 0; });
  Reap();
  Entry* entry = PickNext(1);
  if (entry == nullptr || !Grant(entry)) {
    return true;
  }
  const double turn = Seconds(settings_.slice).count() * settings_.slices_per_turn;
  const double limit = settings_.job_time_limit - entry->seconds;
  const auto has_ended = [entry] { return entry->state == State::kEnded; };
  wait_for(std::min(turn, limit), has_ended);
  const bool ended = has_ended();
  if (!ended) {
    entry->slices += settings_.slices_per_turn - 1;
    EndSlice(entry);
    wait_for(kForever, [&] { return has_ended() || entry->state == State::kPaused; });
  }
  Reap();
  return ended;
}

void ConfirmationQueue::CancelAll(const std::string& reason) {
  dispatcher_ = std::jthread();
  std::unique_lock lock(mutex_);
  workers_ = 0;
  for (const auto& entry : entries_) {
    Overrule(entry.get(), JobOutcome::kCancelled, reason);
  }
  event_.wait(lock, [this] {
    return std::all_of(entries_.begin(), entries_.end(),
                       [](const auto& entry) { return entry->state == State::kEnded; });
  });
  Reap();
}

void ConfirmationQueue::RunJob(Entry* entry) {
  JobResult result = Examine(entry->job.get(), &entry->control);
  entry->job.reset();
  const std::lock_guard lock(mutex_);
  AddUp(entry);
  entry->result = std::move(result);
  entry->state = State::kEnded;
  Notify();
}

void ConfirmationQueue::OnHeld(Entry* entry) {
  const std::lock_guard lock(mutex_);
  AddUp(entry);
  entry->state = State::kPaused;
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
  for (const auto& entry : entries_) {
    if (entry->state == State::kRunning && now - entry->slice_begin >= settings_.slice) {
      EndSlice(entry.get());
    }
  }
}

void ConfirmationQueue::EndSlice(Entry* entry) {
  AddUp(entry);
  ++entry->slices;
  const bool somebody_waits = NumWithState(State::kWaiting, State::kPaused) > 0;
  if (entry->seconds >= settings_.job_time_limit) {
    Overrule(entry, JobOutcome::kFailed, NoVerdictAfter(entry->seconds, ""));
  } else if ((somebody_waits || workers_ == 0) && !entry->overruling) {
    entry->state = State::kPausing;
    if (entry->control.Pause()) {
      entry->state = State::kPaused;
    }
  }
}

void ConfirmationQueue::GrantPermits() {
  while (NumWithState(State::kRunning, State::kPausing) < workers_) {
    Entry* next = PickNext(settings_.rotating_jobs_per_worker * workers_);
    if (next == nullptr) {
      return;
    }
    Grant(next);
  }
}

bool ConfirmationQueue::Grant(Entry* entry) {
  const bool begins = entry->state == State::kWaiting;
  entry->last_served = ++grants_;
  entry->slice_begin = Clock::now();
  entry->state = State::kRunning;
  if (!begins) {
    entry->control.Resume();
    return true;
  }
  try {
    entry->thread = std::thread([this, entry] { RunJob(entry); });
  } catch (const std::system_error& error) {
    entry->result.reason = error.what();
    entry->state = State::kEnded;
    Notify();
    return false;
  }
  return true;
}

void ConfirmationQueue::AddUp(Entry* entry) {
  if (entry->state == State::kRunning || entry->state == State::kPausing) {
    const Clock::time_point now = Clock::now();
    entry->seconds += Seconds(now - entry->slice_begin).count();
    entry->slice_begin = now;
  }
}

void ConfirmationQueue::Overrule(Entry* entry, JobOutcome outcome, const std::string& reason) {
  if (entry->state == State::kEnded || entry->overruling) {
    return;
  }
  entry->overruling = {outcome, reason};
  entry->control.Cancel();
  if (entry->state == State::kWaiting) {
    entry->state = State::kEnded;
  }
}

void ConfirmationQueue::Reap() {
  const auto has_ended = [](const auto& entry) { return entry->state == State::kEnded; };
  for (const auto& entry : entries_) {
    if (!has_ended(entry)) {
      continue;
    }
    if (entry->thread.joinable()) {
      entry->thread.join();
    }
    JobResult& result = finished_.emplace_back(std::move(entry->result));
    if (entry->overruling) {
      result.outcome = entry->overruling->outcome;
      result.reason = std::move(entry->overruling->reason);
    }
    result.tag = entry->tag;
    result.seconds = entry->seconds;
  }
  if (std::erase_if(entries_, has_ended) > 0) {
    result_.notify_all();
  }
}

void ConfirmationQueue::MakeRoom() {
  Entry* slowest = nullptr;
  for (const auto& entry : entries_) {
    if (entry->overruling && HasThread(*entry)) {
      return;
    }
    if (entry->state == State::kPaused && entry->slices >= settings_.slices_per_turn &&
        (slowest == nullptr || entry->seconds > slowest->seconds)) {
      slowest = entry.get();
    }
  }
  if (slowest != nullptr) {
    Overrule(slowest, JobOutcome::kFailed,
             NoVerdictAfter(slowest->seconds, ", gave way to other jobs"));
  }
}

ConfirmationQueue::Entry* ConfirmationQueue::PickNext(int num_rotating) {
  const auto has_thread = [](const auto& entry) { return HasThread(*entry); };
  const bool full =
      std::count_if(entries_.begin(), entries_.end(), has_thread) >= settings_.max_threads;
  if (full && NumWithState(State::kWaiting, State::kWaiting) > 0) {
    MakeRoom();
  }
  std::vector<Entry*> ranked = Ranked();
  if (full) {
    std::erase_if(ranked, [](Entry* entry) { return entry->state == State::kWaiting; });
  }
  const bool fair = (grants_ + 1) % settings_.slices_per_fair_slice == 0;
  if (!fair && static_cast<int>(ranked.size()) > num_rotating) {
    ranked.resize(num_rotating);
  }
  const auto waits = [](Entry* entry) {
    return entry->state == State::kWaiting || entry->state == State::kPaused;
  };
  const auto waited_longer = [fair](Entry* a, Entry* b) {
    const bool a_is_new = !fair && a->state == State::kWaiting;
    const bool b_is_new = !fair && b->state == State::kWaiting;
    return a_is_new != b_is_new ? a_is_new : !a_is_new && a->last_served < b->last_served;
  };
  std::erase_if(ranked, [&](Entry* entry) { return !waits(entry); });
  const auto next = std::min_element(ranked.begin(), ranked.end(), waited_longer);
  return next == ranked.end() ? nullptr : *next;
}

std::vector<ConfirmationQueue::Entry*> ConfirmationQueue::Ranked() const {
  std::vector<Entry*> ranked;
  for (const auto& entry : entries_) {
    if (entry->state != State::kEnded && !entry->overruling) {
      ranked.push_back(entry.get());
    }
  }
  const auto ranks_before = [this](Entry* a, Entry* b) {
    const std::int64_t turns_a = a->slices / settings_.slices_per_turn;
    const std::int64_t turns_b = b->slices / settings_.slices_per_turn;
    return turns_a != turns_b ? turns_a < turns_b : a->cost < b->cost;
  };
  std::stable_sort(ranked.begin(), ranked.end(), ranks_before);
  return ranked;
}

bool ConfirmationQueue::HasThread(const Entry& entry) { return entry.thread.joinable(); }

int ConfirmationQueue::NumWithState(State a, State b) const {
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(), [=](const auto& entry) {
    return entry->state == a || entry->state == b;
  }));
}

std::optional<ConfirmationQueue::Clock::time_point> ConfirmationQueue::NextSliceEnd() const {
  std::optional<Clock::time_point> next;
  for (const auto& entry : entries_) {
    if (entry->state == State::kRunning && !entry->overruling) {
      const Clock::time_point end = entry->slice_begin + settings_.slice;
      next = next ? std::min(*next, end) : end;
    }
  }
  return next;
}

ConfirmationQueue::Entry* ConfirmationQueue::Find(int tag) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [tag](const auto& entry) { return entry->tag == tag; });
  return found == entries_.end() ? nullptr : found->get();
}

void ConfirmationQueue::Notify() {
  news_ = true;
  event_.notify_all();
}

}  // namespace possibility::graph
