#pragma once

#include <cstdint>
#include <optional>

#include "graph/action_exploration.h"

namespace possibility::graph {

/// Algorithm 3: grows the graph of a holonomic action and connects its subgraphs.
class HolonomicExploration : public ActionExploration {
 public:
  HolonomicExploration(const HolonomicAction& action, int index, const ExplorerContext& context);

  NewElements GrowTowards(const Point& p_target) override;

 private:
  /// Which way edges point in relation to the growth that finds them. Matters only to actions
  /// that are not reversible.
  enum class Execution { kWithGrowth, kAgainstGrowth };

  /// Where Connect grows to: a point of E, perhaps that of a vertex.
  struct Target {
    Point point;
    std::optional<VertexId> vertex;
  };

  struct Connection {
    NewElements found;
    VertexId last = 0;  ///< where the growth ended; its start if it found nothing
  };

  Connection Connect(VertexId v_start, const Target& target, Execution execution);
  /// Extends the connection to the point v_p; false if there is no getting there.
  bool AppendEdge(const Point& v_p, Execution execution, Connection* connection);

  std::optional<VertexId> ChooseRoot(const Point& p_target);
  bool IsWorthJoining(VertexId v_0, VertexId v_1) const;
  Execution ExecutionOfFirst(VertexId v_0) const;
  Execution ExecutionOfSecond(VertexId v_1, VertexId v_0) const;

  const HolonomicAction& action_;
  std::int64_t* vertices_rejected_;
  std::int64_t* edges_rejected_;
  std::int64_t* edges_refused_;
  std::int64_t* edges_made_;
};

}  // namespace possibility::graph
