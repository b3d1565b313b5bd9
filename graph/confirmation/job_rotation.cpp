#include "graph/confirmation/job_rotation.h"

#include <algorithm>

namespace possibility::graph {
namespace {

using Jobs = std::vector<std::unique_ptr<QueuedJob>>;
using State = QueuedJob::State;

/// Overrules the slowest paused job that has had its turn, unless an overruled job is about to end.
void MakeRoom(const Jobs& jobs, const RotationSettings& settings) {
  QueuedJob* slowest = nullptr;
  for (const auto& job : jobs) {
    if (job->overruling && job->HasThread()) {
      return;
    }
    if (job->state == State::kPaused && job->slices >= settings.slices_per_turn &&
        (slowest == nullptr || job->slices > slowest->slices)) {
      slowest = job.get();
    }
  }
  if (slowest != nullptr) {
    slowest->Overrule(JobOutcome::kFailed,
                      NoVerdictAfter(slowest->seconds, ", gave way to other jobs"));
  }
}

std::vector<QueuedJob*> Ranked(const Jobs& jobs, const RotationSettings& settings) {
  std::vector<QueuedJob*> ranked;
  for (const auto& job : jobs) {
    if (job->state != State::kEnded && !job->overruling) {
      ranked.push_back(job.get());
    }
  }
  const auto ranks_before = [&settings](QueuedJob* a, QueuedJob* b) {
    const std::int64_t turns_a = a->slices / settings.slices_per_turn;
    const std::int64_t turns_b = b->slices / settings.slices_per_turn;
    return turns_a != turns_b ? turns_a < turns_b : a->cost < b->cost;
  };
  std::stable_sort(ranked.begin(), ranked.end(), ranks_before);
  return ranked;
}

}  // namespace

QueuedJob* PickNext(const Jobs& jobs, const RotationSettings& settings, int num_rotating,
                    std::int64_t grants) {
  const auto has_thread = [](const auto& job) { return job->HasThread(); };
  const auto is_new = [](const auto& job) { return job->state == State::kWaiting; };
  const bool full = std::count_if(jobs.begin(), jobs.end(), has_thread) >= settings.max_threads;
  if (full && std::any_of(jobs.begin(), jobs.end(), is_new)) {
    MakeRoom(jobs, settings);
  }
  std::vector<QueuedJob*> ranked = Ranked(jobs, settings);
  if (full) {
    std::erase_if(ranked, is_new);
  }
  const bool fair = (grants + 1) % settings.slices_per_fair_slice == 0;
  if (!fair && static_cast<int>(ranked.size()) > num_rotating) {
    ranked.resize(num_rotating);
  }
  const auto waits = [](QueuedJob* job) {
    return job->state == State::kWaiting || job->state == State::kPaused;
  };
  const auto waited_longer = [fair](QueuedJob* a, QueuedJob* b) {
    const bool a_is_new = !fair && a->state == State::kWaiting;
    const bool b_is_new = !fair && b->state == State::kWaiting;
    return a_is_new != b_is_new ? a_is_new : !a_is_new && a->last_served < b->last_served;
  };
  std::erase_if(ranked, [&](QueuedJob* job) { return !waits(job); });
  const auto next = std::min_element(ranked.begin(), ranked.end(), waited_longer);
  return next == ranked.end() ? nullptr : *next;
}

}  // namespace possibility::graph
