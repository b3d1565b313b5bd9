#pragma once

#include <cstdint>
#include <optional>

#include "graph/search/action_exploration.h"

namespace possibility::graph {

/// Algorithm 3: grows the graph of a holonomic action and connects its subgraphs.
class HolonomicExploration : public ActionExploration {
 public:
  HolonomicExploration(const HolonomicAction& action, int index, const ExplorerContext& context);

  NewElements GrowTowards(const Point& p_target) override;

 private:
  /// Direction of the new edges relative to the growth that finds them. Matters only for actions
  /// that are not reversible.
  enum class Execution { kWithGrowth, kAgainstGrowth };

  /// The point that Connect grows to, with its vertex if it is one.
  struct Target {
    Point point;
    std::optional<VertexId> vertex;
  };

  struct Connection {
    NewElements found;
    VertexId last = 0;  ///< where the growth ended; its start if it found nothing
  };

  Connection Connect(VertexId v_start, const Target& target, Execution execution);
  /// Extends the connection to the point v_p; false if that is not possible.
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
