#include "graph/search/transition_queue.h"

#include <utility>

#include "graph/action/random.h"

namespace possibility::graph {

void TransitionQueue::Insert(VertexId vertex) {
  if (vertex >= static_cast<int>(queued_before_.size())) {
    queued_before_.resize(vertex + 1, false);
  }
  if (!queued_before_[vertex]) {
    queued_before_[vertex] = true;
    waiting_.push_back(vertex);
  }
}

std::optional<VertexId> TransitionQueue::PopRandom(RandomGenerator* generator) {
  if (waiting_.empty()) {
    return std::nullopt;
  }
  std::swap(waiting_[UniformIndex(waiting_.size(), generator)], waiting_.back());
  const VertexId vertex = waiting_.back();
  waiting_.pop_back();
  return vertex;
}

}  // namespace possibility::graph
