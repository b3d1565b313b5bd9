#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "graph/action_exploration.h"
#include "graph/confirmation_queue.h"
#include "graph/deadline.h"
#include "graph/find_path.h"
#include "graph/possibility_graph.h"

namespace possibility::graph {

/// ConfirmPath of Algorithm 1, and what becomes of the edges it hands to confirmation jobs.
class PathConfirmation {
 public:
  /// Everything pointed to must outlive this.
  PathConfirmation(const std::vector<std::shared_ptr<const Action>>& actions,
                   PossibilityGraph* master, ConfirmationQueue* queue, const Deadline* deadline,
                   Counters* counters);

  /// Whether every edge of a path is possible. Edges that meet no sufficient conditions are
  /// removed from the graph and handed to a confirmation job. Gives up, false, at the deadline.
  bool ConfirmPath(const std::vector<EdgeId>& path);

  /// An unexamined edge of `action` is known to meet its sufficient conditions.
  void OnSufficientConditions(int action, VertexId from, VertexId to);

  /// Puts edges that were confirmed since the last call back into the graph. Now and then also
  /// revalues the jobs that are under way, by the graph as it is now.
  void CollectResults();

  /// A path of this expected duration is confirmed: jobs whose answer cannot lead to a quicker one
  /// are cancelled, now and whenever jobs are revalued.
  void SetBound(double duration);

  /// Ends all jobs.
  void CancelJobs();

  int num_jobs() const { return num_jobs_; }

  /// Jobs that refuted their edges.
  int num_refuted() const { return num_refuted_; }

  /// Takes what the jobs found out so far.
  std::vector<ConfirmationReport> TakeReports() { return std::exchange(reports_, {}); }

 private:
  /// One edge on its way through the actions that might confirm it.
  struct Examination {
    EdgeId edge = 0;
    int next = 0;            ///< position in the order of actions of who is asked next
    int asked = 0;           ///< the action whose job is under way
    bool undecided = false;  ///< some job failed
    bool open = false;       ///< a job is in the queue
    /// Expected duration of the quickest route through the edge, were all edges confirmed that
    /// jobs examine, s.
    double route_duration = 0;
  };

  bool Confirm(EdgeId edge, double route_duration);
  bool MeetsSufficientConditions(EdgeId edge);
  void SpawnConfirmationJob(int examination);
  void OnConfirmed(EdgeId edge, int action);
  /// Takes the queue's results into the counters and reports.
  std::vector<JobResult> Report();
  void RevalueJobs();
  /// Whether confirmed edges lead from one end of each open direction to the other as quickly.
  bool IsOutdone(EdgeId edge) const;
  /// Of all actions the one that found the edge comes first.
  int ActionAt(EdgeId edge, int position) const;
  /// The edge as `action` is asked for it.
  PointPair PointsFor(EdgeId edge, int action) const;
  /// The edge, and its opposite unless that is known to be possible.
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
