#include "graph/path_confirmation.h"

#include <algorithm>
#include <utility>

namespace possibility::graph {

PathConfirmation::PathConfirmation(const std::vector<std::shared_ptr<const Action>>& actions,
                                   PossibilityGraph* master, ConfirmationQueue* queue,
                                   const Deadline* deadline, Counters* counters)
    : actions_(actions), master_(master), queue_(queue), deadline_(deadline), counters_(counters) {
  for (const char* name : {"edges confirmed by C_S", "edges without job", "jobs spawned",
                           "jobs confirmed", "jobs refuted", "jobs failed"}) {
    (*counters_)[name] = 0;
  }
}

bool PathConfirmation::ConfirmPath(const std::vector<EdgeId>& path) {
  bool path_confirmed = true;
  for (const EdgeId edge : path) {
    if (deadline_->Passed()) {
      return false;
    }
    if (!Confirm(edge)) {
      path_confirmed = false;
    }
  }
  return path_confirmed;
}

bool PathConfirmation::Confirm(EdgeId edge) {
  // The opposite of an edge earlier on the same path may have been removed with it.
  if (master_->possibility(edge) != Possibility::kUnexamined) {
    return master_->possibility(edge) == Possibility::kPossible;
  }
  if (MeetsSufficientConditions(edge)) {
    return true;
  }
  for (const EdgeId open : OpenPair(edge)) {
    master_->Remove(open);
    master_->SetPossibility(open, Possibility::kIndeterminate);
  }
  examinations_.push_back({.edge = edge});
  SpawnConfirmationJob(static_cast<int>(examinations_.size()) - 1);
  return false;
}

bool PathConfirmation::MeetsSufficientConditions(EdgeId edge) {
  for (int i = 0; i < static_cast<int>(actions_.size()); ++i) {
    const int a = ActionAt(edge, i);
    if (actions_[a]->CS(PointsFor(edge, a))) {
      OnConfirmed(edge, a);
      ++(*counters_)["edges confirmed by C_S"];
      return true;
    }
  }
  return false;
}

void PathConfirmation::SpawnConfirmationJob(int examination) {
  Examination& examined = examinations_[examination];
  while (examined.next < static_cast<int>(actions_.size())) {
    const int a = ActionAt(examined.edge, examined.next++);
    const PointPair points = PointsFor(examined.edge, a);
    if (!actions_[a]->CN(points)) {
      continue;
    }
    if (auto job = actions_[a]->SpawnConfirmationJob(points)) {
      examined.asked = a;
      queue_->Insert(examination, std::move(job));
      ++num_jobs_;
      ++(*counters_)["jobs spawned"];
      return;
    }
    ++(*counters_)["edges without job"];
  }
  if (!examined.undecided) {
    for (const EdgeId open : OpenPair(examined.edge)) {
      master_->SetPossibility(open, Possibility::kImpossible);
    }
  }
}

void PathConfirmation::CollectResults() {
  for (JobResult& result : queue_->DrainFinished()) {
    Examination& examined = examinations_[result.tag];
    reports_.push_back({.action = examined.asked,
                        .points = PointsFor(examined.edge, examined.asked),
                        .outcome = result.outcome,
                        .reason = std::move(result.reason),
                        .seconds = result.seconds});
    if (result.outcome == JobOutcome::kConfirmed) {
      ++(*counters_)["jobs confirmed"];
      OnConfirmed(examined.edge, examined.asked);
      continue;
    }
    const bool failed = result.outcome == JobOutcome::kFailed;
    ++(*counters_)[failed ? "jobs failed" : "jobs refuted"];
    examined.undecided = examined.undecided || failed;
    SpawnConfirmationJob(result.tag);
  }
}

void PathConfirmation::OnConfirmed(EdgeId edge, int action) {
  const std::vector<EdgeId> pair =
      actions_[action]->IsReversible() ? OpenPair(edge) : std::vector<EdgeId>{edge};
  for (const EdgeId confirmed : pair) {
    master_->SetPossible(confirmed, action);
    master_->Reinsert(confirmed);
  }
}

int PathConfirmation::ActionAt(EdgeId edge, int position) const {
  const int own = master_->action(edge);
  if (position == 0) {
    return own;
  }
  return position <= own ? position - 1 : position;
}

PointPair PathConfirmation::PointsFor(EdgeId edge, int action) const {
  const auto opposite = master_->opposite(edge);
  const bool as_found = action == master_->action(edge) && opposite;
  return master_->points(as_found ? std::min(edge, *opposite) : edge);
}

std::vector<EdgeId> PathConfirmation::OpenPair(EdgeId edge) const {
  const auto opposite = master_->opposite(edge);
  if (opposite && master_->possibility(*opposite) != Possibility::kPossible) {
    return {edge, *opposite};
  }
  return {edge};
}

}  // namespace possibility::graph
