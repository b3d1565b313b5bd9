#include "graph/confirmation/confirmation_turns.h"

#include <algorithm>

namespace possibility::graph {
namespace {

/// Work of a turn of length 1: 1000 checkpoints a few milliseconds apart, s.
constexpr double kWorkOfTurn = 3;

/// A turn of this length takes nearly a job's whole time limit.
constexpr int kLongestTurn = 8;

}  // namespace

void ConfirmationTurns::RunTurnIfDue(double work, bool exploration_is_over,
                                     const Deadline& deadline) {
  if (work < next_turn_ && !exploration_is_over) {
    return;
  }
  if (queue_->RunTurn(deadline, turn_length_)) {
    turn_length_ = std::max(turn_length_ - 1, 1);
  } else {
    next_turn_ = work + turn_length_ * kWorkOfTurn;
    turn_length_ = std::min(turn_length_ + 1, kLongestTurn);
  }
}

}  // namespace possibility::graph
