#pragma once

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// Vertices in ascending order of distance; equal distances in the order of vertex number.
class SortedVertexQueue {
 public:
  void Insert(double distance, VertexId vertex) { queue_.emplace(distance, vertex); }

  bool empty() const { return queue_.empty(); }
  VertexId Front() const { return queue_.top().second; }

  VertexId PopFront() {
    const VertexId front = Front();
    queue_.pop();
    return front;
  }

 private:
  using Entry = std::pair<double, VertexId>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace possibility::graph
