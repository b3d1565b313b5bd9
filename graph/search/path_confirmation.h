#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "common/deadline.h"
#include "graph/confirmation/confirmation_queue.h"
#include "graph/search/action_exploration.h"
#include "graph/search/find_path.h"
#include "graph/structure/possibility_graph.h"

namespace possibility::graph {

/// ConfirmPath of Algorithm 1, and the further course of the edges that it hands to confirmation
/// jobs.
class PathConfirmation {
 public:
  /// Everything pointed to must outlive this.
  PathConfirmation(const std::vector<std::shared_ptr<const Action>>& actions,
                   PossibilityGraph* master, ConfirmationQueue* queue, const Deadline* deadline,
                   Counters* counters);

  /// Whether every edge of a path is possible. Edges that meet no sufficient conditions are removed
  /// from the graph and handed to a confirmation job. Gives up at the deadline and returns false.
  bool ConfirmPath(const std::vector<EdgeId>& path);

  /// Marks an unexamined edge of `action` as possible because it meets its sufficient conditions.
  void OnSufficientConditions(int action, VertexId from, VertexId to);

  /// Puts edges that were confirmed since the last call back into the graph. From time to time also
  /// updates the costs of the open jobs from the current graph.
  void CollectResults();

  /// Sets the expected duration of the confirmed path. Jobs that cannot lead to a quicker path are
  /// cancelled, now and whenever costs are updated.
  void SetBound(double duration);

  /// Ends all jobs.
  void CancelJobs();

  int num_jobs() const { return num_jobs_; }

  /// Number of jobs that refuted their edges.
  int num_refuted() const { return num_refuted_; }

  /// Takes the reports of the jobs that ended so far.
  std::vector<ConfirmationReport> TakeReports() { return std::exchange(reports_, {}); }

 private:
  /// The examination of one edge by the actions that might confirm it.
  struct Examination {
    EdgeId edge = 0;
    int next = 0;            ///< position of the action that is asked next, see ActionAt
    int asked = 0;           ///< the action whose job is under way
    bool undecided = false;  ///< some job failed
    bool open = false;       ///< a job is in the queue
    /// Expected duration of the quickest route through the edge, assuming that all open jobs
    /// confirm their edges, s.
    double route_duration = 0;
  };

  bool Confirm(EdgeId edge, double route_duration);
  bool MeetsSufficientConditions(EdgeId edge);
  void SpawnConfirmationJob(int examination);
  void OnConfirmed(EdgeId edge, int action);
  /// Moves the queue's results into the counters and reports.
  std::vector<JobResult> Report();
  void RevalueJobs();
  /// Whether confirmed edges connect the same vertices as quickly, in each direction still open.
  bool IsOutdone(EdgeId edge) const;
  /// The order in which actions are asked: first the action that found the edge, then the others.
  int ActionAt(EdgeId edge, int position) const;
  /// The points of the edge as `action` is asked for them.
  Edge PointsFor(EdgeId edge, int action) const;
  /// The edge, and its opposite unless that is already confirmed.
  std::vector<EdgeId> OpenPair(EdgeId edge) const;

  std::vector<std::shared_ptr<const Action>> actions_;
  PossibilityGraph* master_;
  ConfirmationQueue* queue_;
  const Deadline* deadline_;
  Counters* counters_;
  std::vector<Examination> examinations_;  ///< the queue's tags are indices into it
  std::vector<ConfirmationReport> reports_;
  int num_jobs_ = 0;
  int num_refuted_ = 0;
  double bound_ = std::numeric_limits<double>::infinity();  ///< s
  int collections_since_revaluation_ = 0;
};

}  // namespace possibility::graph
