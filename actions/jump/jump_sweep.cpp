#include "actions/jump/jump_sweep.h"

#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

namespace possibility::actions {
namespace {

/// Distributes heights to workers; a worker goes through the distances of its height.
class SweepQueue {
 public:
  SweepQueue(const JumpSweep& sweep, JumpLibrary* library)
      : sweep_(sweep),
        library_(*library),
        distances_(1 + static_cast<int>(std::lround((sweep.farthest - sweep.shortest) /
                                                    JumpLibrary::kDistanceStep))),
        entries_(sweep.heights.size()) {}

  void Work() {
    try {
      for (std::size_t row = next_++; row < entries_.size() && !ended_; row = next_++) {
        SweepHeight(sweep_.heights[row], &entries_[row]);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      ended_ = true;
    }
  }

  std::vector<JumpSweepEntry> Take() {
    if (error_) std::rethrow_exception(error_);
    std::vector<JumpSweepEntry> all;
    for (auto& row : entries_) all.insert(all.end(), row.begin(), row.end());
    return all;
  }

 private:
  void SweepHeight(double height, std::vector<JumpSweepEntry>* row) {
    bool found = false;
    int refusals = 0;
    for (int i = 0; i < distances_ && !ended_; ++i) {
      const JumpTask task =
          JumpLibrary::OnGrid({sweep_.shortest + i * JumpLibrary::kDistanceStep, height});
      row->push_back(Answer(task));
      found = found || row->back().is_possible;
      refusals = row->back().is_possible ? 0 : refusals + 1;
      const bool stop = sweep_.refusals_to_stop > 0 && found && refusals >= sweep_.refusals_to_stop;
      Report(stop ? distances_ - i : 1);
      if (stop) return;
    }
  }

  JumpSweepEntry Answer(const JumpTask& task) {
    JumpSweepEntry entry;
    entry.task = task;
    std::optional<JumpAnswer> answer = library_.Find(task);
    entry.was_known = answer.has_value();
    if (!answer) answer = library_.FindOrSolve(task);
    // A known one, too, if its folder has no motion.
    if (answer->jump && answer->solution) library_.Save(*answer, task);
    entry.is_possible = answer->jump != nullptr;
    entry.reason = answer->reason;
    entry.effort = answer->effort;
    return entry;
  }

  void Report(int answered) {
    const std::lock_guard lock(mutex_);
    done_ += answered;
    const int all = distances_ * static_cast<int>(entries_.size());
    if (sweep_.progress) sweep_.progress(done_, all);
    if (!sweep_.cancellation.Proceed()) ended_ = true;
  }

  const JumpSweep& sweep_;
  JumpLibrary& library_;
  int distances_;
  std::vector<std::vector<JumpSweepEntry>> entries_;  // by height
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> ended_ = false;
  std::mutex mutex_;
  int done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

std::vector<JumpSweepEntry> SweepJumps(const JumpSweep& sweep, JumpLibrary* library) {
  SweepQueue queue(sweep, library);
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < sweep.threads; ++i) others.emplace_back([&queue] { queue.Work(); });
    queue.Work();
  }
  return queue.Take();
}

JumpReach ReachOf(const std::vector<JumpSweepEntry>& entries) {
  JumpReach reach;
  for (const JumpSweepEntry& entry : entries) {
    if (reach.rows.empty() || reach.rows.back().height != entry.task.height) {
      reach.rows.push_back({entry.task.height, std::numeric_limits<double>::max(), 0});
    }
    if (!entry.is_possible) continue;
    JumpReach::Row& row = reach.rows.back();
    row.shortest = std::min(row.shortest, entry.task.distance);
    row.farthest = std::max(row.farthest, entry.task.distance);
  }
  for (JumpReach::Row& row : reach.rows) {
    if (row.farthest < row.shortest) row.shortest = 1;  // farthest 0: none
  }
  return reach;
}

}  // namespace possibility::actions
