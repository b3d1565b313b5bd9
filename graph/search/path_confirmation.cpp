#include "graph/search/path_confirmation.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace possibility::graph {
namespace {

constexpr const char* kCounterOf[] = {"jobs confirmed", "jobs refuted", "jobs failed",
                                      "jobs cancelled"};

/// An update takes two passes over the whole graph, too much for every cycle.
constexpr int kCollectionsPerRevaluation = 50;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

PathConfirmation::PathConfirmation(const std::vector<std::shared_ptr<const Action>>& actions,
                                   PossibilityGraph* master, ConfirmationQueue* queue,
                                   const Deadline* deadline, Counters* counters)
    : actions_(actions), master_(master), queue_(queue), deadline_(deadline), counters_(counters) {
  for (const char* name : {"edges confirmed by C_S", "edges without job", "jobs spawned"}) {
    (*counters_)[name] = 0;
  }
  for (const char* name : kCounterOf) {
    (*counters_)[name] = 0;
  }
}

bool PathConfirmation::ConfirmPath(const std::vector<EdgeId>& path) {
  const double duration =
      std::accumulate(path.begin(), path.end(), 0.0,
                      [this](double sum, EdgeId edge) { return sum + master_->duration(edge); });
  bool path_confirmed = true;
  for (const EdgeId edge : path) {
    if (deadline_->Passed()) {
      return false;
    }
    if (!Confirm(edge, duration)) {
      path_confirmed = false;
    }
  }
  return path_confirmed;
}

void PathConfirmation::OnSufficientConditions(int action, VertexId from, VertexId to) {
  const std::optional<EdgeId> edge = master_->FindEdge(action, from, to);
  if (!edge || master_->possibility(*edge) != Possibility::kUnexamined) {
    return;
  }
  OnConfirmed(*edge, action);
  ++(*counters_)["edges confirmed by C_S"];
}

bool PathConfirmation::Confirm(EdgeId edge, double route_duration) {
  // The edge may have been removed as the opposite of an edge earlier on the same path.
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
  examinations_.push_back({.edge = edge, .route_duration = route_duration});
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
    const Edge points = PointsFor(examined.edge, a);
    if (!actions_[a]->CN(points)) {
      continue;
    }
    if (auto job = actions_[a]->SpawnConfirmationJob(points)) {
      examined.asked = a;
      examined.open = true;
      queue_->Insert(examination, std::move(job), examined.route_duration);
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
  const std::vector<JobResult> results = Report();
  for (const JobResult& result : results) {
    Examination& examined = examinations_[result.tag];
    switch (result.outcome) {
      case JobOutcome::kConfirmed:
        OnConfirmed(examined.edge, examined.asked);
        master_->RefreshDuration(examined.edge);
        break;
      case JobOutcome::kFailed:
        examined.undecided = true;
        [[fallthrough]];
      case JobOutcome::kRefuted:
        SpawnConfirmationJob(result.tag);
        break;
      case JobOutcome::kCancelled:
        break;
    }
  }
  ++collections_since_revaluation_;
  if (queue_->num_open() > 0 &&
      (!results.empty() || collections_since_revaluation_ >= kCollectionsPerRevaluation)) {
    RevalueJobs();
    collections_since_revaluation_ = 0;
  }
}

std::vector<JobResult> PathConfirmation::Report() {
  std::vector<JobResult> results = queue_->DrainFinished();
  for (const JobResult& result : results) {
    Examination& examined = examinations_[result.tag];
    examined.open = false;
    ++(*counters_)[kCounterOf[static_cast<int>(result.outcome)]];
    num_refuted_ += result.outcome == JobOutcome::kRefuted ? 1 : 0;
    reports_.push_back({.action = examined.asked,
                        .points = PointsFor(examined.edge, examined.asked),
                        .outcome = result.outcome,
                        .reason = result.reason,
                        .seconds = result.seconds});
  }
  return results;
}

void PathConfirmation::SetBound(double duration) {
  bound_ = duration;
  RevalueJobs();
}

void PathConfirmation::CancelJobs() {
  queue_->CancelAll("the search is over");
  Report();
}

void PathConfirmation::RevalueJobs() {
  const DirectedGraph& topology = master_->topology();
  std::vector<bool> open_edge(topology.num_edges(), false);
  for (const Examination& examined : examinations_) {
    for (const EdgeId edge : examined.open ? OpenPair(examined.edge) : std::vector<EdgeId>{}) {
      open_edge[edge] = true;
    }
  }
  const auto include = [&](EdgeId edge) { return open_edge[edge] || !topology.removed(edge); };
  const std::vector<double> from_start =
      master_->LeastDurations({master_->start()}, Reachability::Direction::kDownstream, include);
  const std::vector<double> to_goal =
      master_->LeastDurations(master_->goals(), Reachability::Direction::kUpstream, include);
  for (int i = 0; i < static_cast<int>(examinations_.size()); ++i) {
    Examination& examined = examinations_[i];
    if (!examined.open) {
      continue;
    }
    examined.route_duration = std::numeric_limits<double>::infinity();
    for (const EdgeId edge : OpenPair(examined.edge)) {
      const double route =
          from_start[topology.from(edge)] + master_->duration(edge) + to_goal[topology.to(edge)];
      examined.route_duration = std::min(examined.route_duration, route);
    }
    queue_->SetCost(i, examined.route_duration);
    if (IsOutdone(examined.edge)) {
      queue_->Cancel(i, "confirmed edges lead the same way as quickly");
    } else if (examined.route_duration >= bound_ && bound_ < kUnbounded) {
      queue_->Cancel(i, "a route as quick is confirmed");
    }
  }
}

bool PathConfirmation::IsOutdone(EdgeId edge) const {
  const DirectedGraph& topology = master_->topology();
  const auto confirmed = [&](EdgeId other) {
    return !topology.removed(other) && master_->possibility(other) == Possibility::kPossible;
  };
  const std::vector<EdgeId> open = OpenPair(edge);
  return std::all_of(open.begin(), open.end(), [&](EdgeId e) {
    return master_->LeadsWithin(topology.from(e), topology.to(e), master_->duration(e), confirmed);
  });
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

Edge PathConfirmation::PointsFor(EdgeId edge, int action) const {
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
