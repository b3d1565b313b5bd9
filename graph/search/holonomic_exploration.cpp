#include "graph/search/holonomic_exploration.h"

#include "graph/action/random.h"

namespace possibility::graph {
namespace {

/// Share of growths that begin at a random vertex instead of the closest one, once there are
/// kManyVertices. In rooms full of vertices the closest one is so close that growth is short and
/// goes in every direction; narrow passages need long growths.
constexpr double kShareFromAfar = 0.5;
constexpr int kManyVertices = 200;

}  // namespace

HolonomicExploration::HolonomicExploration(const HolonomicAction& action, int index,
                                           const ExplorerContext& context)
    : ActionExploration(action, index, context),
      action_(action),
      vertices_rejected_(Counter("extend rejected at vertex")),
      edges_rejected_(Counter("extend rejected on edge")),
      edges_refused_(Counter("extend stopped at removed edge")),
      edges_made_(Counter("extend made")) {}

NewElements HolonomicExploration::GrowTowards(const Point& p_target) {
  const std::optional<VertexId> v_0 = ChooseRoot(p_target);
  if (!v_0) {
    return {};
  }
  const Connection first = Connect(*v_0, {p_target, std::nullopt}, ExecutionOfFirst(*v_0));
  NewElements found = first.found;
  const std::optional<VertexId> v_1 = action_graph().FindClosestVertexTo(
      p_target, *v_0, [&](VertexId v) { return IsWorthJoining(*v_0, v); });
  if (v_1) {
    const Target end_of_first = {context().master->point(first.last), first.last};
    found.Append(Connect(*v_1, end_of_first, ExecutionOfSecond(*v_1, *v_0)).found);
  }
  action_graph().Append(found);
  return found;
}

std::optional<VertexId> HolonomicExploration::ChooseRoot(const Point& p_target) {
  const bool from_afar = action_graph().num_vertices() >= kManyVertices &&
                         UniformReal(0, 1, context().generator) < kShareFromAfar;
  return from_afar ? action_graph().RandomVertex(context().generator)
                   : action_graph().FindClosestVertexTo(p_target);
}

/// False if the connection would join the goal's side with itself, or the start's side with itself.
bool HolonomicExploration::IsWorthJoining(VertexId v_0, VertexId v_1) const {
  const PossibilityGraph& master = *context().master;
  if (master.UpstreamFromGoal(v_0)) {
    return !master.UpstreamFromGoal(v_1);
  }
  return !(master.DownstreamFromStart(v_0) && master.DownstreamFromStart(v_1));
}

HolonomicExploration::Connection HolonomicExploration::Connect(VertexId v_start,
                                                               const Target& target,
                                                               Execution execution) {
  Connection connection{.found = {}, .last = v_start};
  Point v = action_.ExtendTowards(context().master->point(v_start), target.point);
  while (!context().deadline->Passed()) {
    const bool reached = SamePoint(v, target.point);
    const bool at_vertex = reached && target.vertex;
    const Point v_p = at_vertex ? target.point : action_.Project(v);
    if (!at_vertex && !action_.Explorable(v_p)) {
      ++*vertices_rejected_;
      break;
    }
    if (!AppendEdge(v_p, execution, &connection) || reached) {
      break;
    }
    const Point next = action_.ExtendTowards(v, target.point);
    if (SamePoint(next, v)) {
      break;
    }
    v = next;
  }
  return connection;
}

bool HolonomicExploration::AppendEdge(const Point& v_p, Execution execution,
                                      Connection* connection) {
  PossibilityGraph& master = *context().master;
  const VertexId v_last = connection->last;
  const std::optional<VertexId> existing = master.FindVertexAt(v_p);
  if (existing == v_last) {
    return true;
  }
  const bool forward = execution == Execution::kWithGrowth;
  if (existing && (forward ? WasRemoved(v_last, *existing) : WasRemoved(*existing, v_last))) {
    ++*edges_refused_;
    return false;
  }
  const Point& last = master.point(v_last);
  if (!action_.Explorable(forward ? Edge{last, v_p} : Edge{v_p, last})) {
    ++*edges_rejected_;
    return false;
  }
  const VertexId v = existing ? *existing : master.VertexAt(v_p);
  if (!action_graph().Contains(v)) {
    connection->found.vertices.push_back(v);
  }
  connection->found.edges.push_back(
      {forward ? v_last : v, forward ? v : v_last, action_.IsReversible()});
  connection->last = v;
  ++*edges_made_;
  return true;
}

HolonomicExploration::Execution HolonomicExploration::ExecutionOfFirst(VertexId v_0) const {
  const PossibilityGraph& master = *context().master;
  const bool from_goal = master.UpstreamFromGoal(v_0) && !master.DownstreamFromStart(v_0);
  return from_goal ? Execution::kAgainstGrowth : Execution::kWithGrowth;
}

HolonomicExploration::Execution HolonomicExploration::ExecutionOfSecond(VertexId v_1,
                                                                        VertexId v_0) const {
  const PossibilityGraph& master = *context().master;
  const bool to_v_1 = master.UpstreamFromGoal(v_1) ||
                      (!master.UpstreamFromGoal(v_0) && master.DownstreamFromStart(v_0) &&
                       !master.DownstreamFromStart(v_1));
  return to_v_1 ? Execution::kAgainstGrowth : Execution::kWithGrowth;
}

}  // namespace possibility::graph
