#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "graph/action/action.h"
#include "graph/action/exploration_space.h"
#include "graph/structure/directed_graph.h"
#include "graph/structure/reachability.h"
#include "graph/structure/vertex_index.h"

namespace possibility::graph {

/// What is known about an edge that exploration accepted.
enum class Possibility {
  kUnexamined,     ///< not yet part of a path to confirm
  kIndeterminate,  ///< meets no sufficient conditions; a confirmation job must decide, or failed to
  kPossible,       ///< meets sufficient conditions, or its job confirmed it
  kImpossible,     ///< no action can confirm it
};

/// An edge found by exploration, not yet in the graphs.
struct NewEdge {
  VertexId from = 0;
  VertexId to = 0;
  bool reversible = false;  ///< also stands for the edge from `to` to `from`
};

/// An edge that a nonholonomic action found for another action: the way to a launch point or from a
/// landing point.
struct LineUpEdge {
  int action = 0;  ///< the action that the edge belongs to
  NewEdge edge;
};

/// {V_new, E_new} of Algorithms 1 to 4: what one action found.
struct NewElements {
  std::vector<VertexId> vertices = {};
  std::vector<NewEdge> edges = {};

  /// Subset of `vertices` that other actions adopt if they accept them: the launch and landing
  /// points of nonholonomic actions.
  std::vector<VertexId> offered = {};
  std::vector<LineUpEdge> line_ups = {};

  void Append(const NewElements& other);
};

/// Gamma_PG: the master graph that combines what all actions found. Always knows which vertices are
/// upstream from a goal and which are downstream from the start.
class PossibilityGraph {
 public:
  /// The graph of `start` and `goals` alone. A goal at the same point as another vertex shares its
  /// vertex. `space` must outlive this.
  PossibilityGraph(const std::vector<std::shared_ptr<const Action>>& actions,
                   const ExplorationSpace* space, const Point& start,
                   const std::vector<Point>& goals);
  PossibilityGraph(const PossibilityGraph&) = delete;
  PossibilityGraph& operator=(const PossibilityGraph&) = delete;

  VertexId start() const { return start_; }
  const std::vector<VertexId>& goals() const { return goals_; }

  /// The vertex at `point`, if there is one.
  std::optional<VertexId> FindVertexAt(const Point& point) const { return index_.Find(point); }
  /// The vertex at `point`; created if there is none.
  VertexId VertexAt(const Point& point);

  /// Adds the edges that `action` found. Existing edges stay unchanged.
  /// @throws std::invalid_argument if the action's expected duration of an edge is negative or not
  /// finite.
  void Append(int action, const std::vector<NewEdge>& edges);

  /// The edge of `action` between two vertices if it was ever added, even if removed since.
  std::optional<EdgeId> FindEdge(int action, VertexId from, VertexId to) const;

  /// Takes an edge out of the graph but remembers it.
  void Remove(EdgeId edge);
  /// Puts a removed edge back.
  void Reinsert(EdgeId edge);

  bool UpstreamFromGoal(VertexId vertex) const { return upstream_from_goal_.Reached(vertex); }
  bool DownstreamFromStart(VertexId vertex) const { return downstream_from_start_.Reached(vertex); }
  /// Whether a path leads from the start to `goal`.
  bool Connected(VertexId goal) const { return DownstreamFromStart(goal); }

  /// Edges of the path from one vertex to another with the least expected duration; nothing if
  /// there is no path.
  std::optional<std::vector<EdgeId>> ShortestPath(VertexId from, VertexId to) const;

  /// Per vertex: least expected duration from any of `roots` along edges that pass `include`,
  /// removed or not; infinite if there is no way. With Direction::kUpstream: least expected
  /// duration to any of `roots`.
  using EdgeFilter = std::function<bool(EdgeId)>;
  std::vector<double> LeastDurations(const std::vector<VertexId>& roots,
                                     Reachability::Direction direction,
                                     const EdgeFilter& include) const;

  /// Whether edges that pass `include` lead from one vertex to another within an expected duration
  /// of `limit`, s.
  bool LeadsWithin(VertexId from, VertexId to, double limit, const EdgeFilter& include) const;

  const ExplorationSpace& space() const { return *space_; }
  const DirectedGraph& topology() const { return topology_; }
  const Point& point(VertexId vertex) const { return points_[vertex]; }
  Edge points(EdgeId edge) const;
  int action(EdgeId edge) const { return edges_[edge].action; }
  /// Asks the action that confirmed the edge, which may know it better now.
  /// @throws std::invalid_argument as Append does.
  void RefreshDuration(EdgeId edge);

  /// Expected duration, s.
  double duration(EdgeId edge) const { return edges_[edge].duration; }
  /// The same edge in the opposite direction, if the action is reversible.
  std::optional<EdgeId> opposite(EdgeId edge) const { return edges_[edge].opposite; }

  Possibility possibility(EdgeId edge) const { return edges_[edge].possibility; }
  /// The action that confirmed the edge, or found it if it is not confirmed.
  int confirmed_by(EdgeId edge) const { return edges_[edge].confirmed_by; }
  void SetPossibility(EdgeId edge, Possibility possibility);
  void SetPossible(EdgeId edge, int confirmed_by);

  /// Number of times an edge of `action` was removed or put back.
  int num_changes(int action) const { return num_changes_[action]; }

 private:
  struct EdgeRecord {
    int action = 0;
    double duration = 0;
    std::optional<EdgeId> opposite;
    Possibility possibility = Possibility::kUnexamined;
    int confirmed_by = 0;
  };

  EdgeId AddEdge(int action, VertexId from, VertexId to);
  double DurationBy(int action, const Edge& points) const;

  std::vector<std::shared_ptr<const Action>> actions_;
  const ExplorationSpace* space_;
  DirectedGraph topology_;
  std::vector<Point> points_;
  std::vector<EdgeRecord> edges_;
  VertexIndex index_;
  Reachability downstream_from_start_{&topology_, Reachability::Direction::kDownstream};
  Reachability upstream_from_goal_{&topology_, Reachability::Direction::kUpstream};
  std::vector<int> num_changes_;
  VertexId start_ = 0;
  std::vector<VertexId> goals_;
};

}  // namespace possibility::graph
