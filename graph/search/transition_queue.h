#pragma once

#include <optional>
#include <vector>

#include "graph/action/exploration_space.h"
#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// Q_Transition: vertices of other actions from which one action has not yet tried a transition.
class TransitionQueue {
 public:
  /// Queues a vertex unless it was queued before.
  void Insert(VertexId vertex);

  /// Takes out a random vertex, all with equal chance; nothing if the queue is empty.
  std::optional<VertexId> PopRandom(RandomGenerator* generator);

  int size() const { return static_cast<int>(waiting_.size()); }

 private:
  std::vector<VertexId> waiting_;
  std::vector<bool> queued_before_;  ///< per vertex
};

}  // namespace possibility::graph
