#pragma once

#include "graph/confirmation_queue.h"
#include "graph/deadline.h"

namespace possibility::graph {

/// Where jobs have no threads of their own: whether it is a job's turn, or exploration's. A turn
/// in vain leaves exploration as much work as it was long, so that jobs get at least half of all
/// work. The next turn is longer, and so is what it leaves: both grow to what the jobs take, and
/// shrink as jobs end. Nothing here asks what time it is: one seed, one search.
class ConfirmationTurns {
 public:
  /// Without jobs to run, nothing happens. `queue` must outlive this.
  explicit ConfirmationTurns(ConfirmationQueue* queue) : queue_(queue) {}

  /// Runs a job's turn if it is time. `work`: that exploration has done since the search began
  /// (Exploration::work), s. `exploration_is_over`: it has nothing to do with the time.
  void RunTurnIfDue(double work, bool exploration_is_over, const Deadline& deadline);

 private:
  ConfirmationQueue* queue_;
  double next_turn_ = 0;  ///< after so much work of exploration, s
  int turn_length_ = 1;
};

}  // namespace possibility::graph
