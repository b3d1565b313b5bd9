#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "graph/action/action.h"

namespace possibility::actions {

/// An edge known to be impossible, and the reason.
struct Refusal {
  graph::Edge edge;
  std::string reason;
};

/// What confirmation jobs and the planner found out about the edges of one action. Thread-safe.
class EdgeVerdicts {
 public:
  /// The last verdict on an edge counts. Edges are the same if their ends are (IsSamePose).
  void Record(const graph::Edge& edge, bool possible, const std::string& reason);

  void Forget(const graph::Edge& edge);

  /// Whether the edge is possible; none if nobody has decided.
  std::optional<bool> On(const graph::Edge& edge) const;

  /// Edges found impossible, in the order of recording.
  std::vector<Refusal> Refusals() const;

 private:
  struct Verdict {
    graph::Edge edge;
    bool possible = false;
    std::string reason;
  };

  mutable std::mutex mutex_;
  std::vector<Verdict> verdicts_;  ///< under mutex_
};

}  // namespace possibility::actions
