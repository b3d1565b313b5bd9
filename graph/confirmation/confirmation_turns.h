#pragma once

#include "common/deadline.h"
#include "graph/confirmation/confirmation_queue.h"

namespace possibility::graph {

/// Shares one thread between jobs and exploration: decides whether a job's turn is due. After a
/// turn in which no job ended, exploration gets as much work as the turn was long, so that jobs get
/// at least half of all work. The next turn is then longer, and so is the wait after it; turns
/// shrink again as jobs end. Counts work, not clock time: the same seed gives the same search.
class ConfirmationTurns {
 public:
  /// `queue` must outlive this. Without jobs in it, nothing happens.
  explicit ConfirmationTurns(ConfirmationQueue* queue) : queue_(queue) {}

  /// Runs a job's turn if one is due. `work`: exploration work since the search began
  /// (Exploration::work), s. `exploration_is_over`: exploration has nothing left to do, so a turn
  /// is always due.
  void RunTurnIfDue(double work, bool exploration_is_over, const Deadline& deadline);

 private:
  ConfirmationQueue* queue_;
  double next_turn_ = 0;  ///< exploration work after which the next turn is due, s
  int turn_length_ = 1;
};

}  // namespace possibility::graph
