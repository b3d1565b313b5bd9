#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "graph/search/action_exploration.h"

namespace possibility::graph {

/// Algorithm 4: grows the graph of a nonholonomic action. Launches near vertices that are not
/// upstream from a goal, and lands near vertices that are not downstream from the start.
class NonholonomicExploration : public ActionExploration {
 public:
  NonholonomicExploration(const NonholonomicAction& action, int index,
                          const ExplorerContext& context);

  NewElements GrowTowards(const Point& p_target) override;
  double growth_work() const override { return work_; }

 private:
  /// Per vertex: still worth trying in this growth.
  using Useful = std::vector<bool>;

  /// Both return true if they found an edge, even one that existed before.
  bool LaunchFrom(VertexId v, const Point& p_target, NewElements* found);
  bool LandAt(VertexId v, const Point& p_target, NewElements* found);

  void CountTry();

  /// Whether the edge and its ends are possibilities of this action.
  bool IsExplorable(const Edge& edge);
  /// The first other action that can take the robot along a line-up edge; nothing if none can.
  std::optional<int> WhoLinesUp(const Edge& line_up) const;
  bool AppendEdges(const Edge& edge, const std::optional<Edge>& line_up, NewElements* found);
  VertexId AppendVertex(const Point& point, NewElements* found);

  void RecursivelySetUpstreamVerticesToFalse(VertexId v, Useful* useful) const;
  void RecursivelySetDownstreamVerticesToFalse(VertexId v, Useful* useful) const;

  const NonholonomicAction& action_;
  double work_ = 0;
  std::int64_t* tried_;
  std::int64_t* rejected_;
  std::int64_t* refused_;
  std::int64_t* not_lined_up_;
  std::int64_t* made_;
};

}  // namespace possibility::graph
