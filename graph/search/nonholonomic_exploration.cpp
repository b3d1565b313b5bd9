#include "graph/search/nonholonomic_exploration.h"

#include "graph/search/sorted_vertex_queue.h"

namespace possibility::graph {
namespace {

/// Limit of launches, and of landings, per growth. Every landing starts a subgraph that may launch
/// again; without a limit the work of one growth would rise with the number of subgraphs.
constexpr int kMostPerGrowth = 3;

/// Declared work of trying one vertex, s. A large graph is tried vertex by vertex, which takes far
/// longer than an action's mean budget; jobs must not wait for it.
constexpr double kWorkOfTry = 20e-6;

/// Sets v and all vertices upstream or downstream from it to false.
void SetToFalse(const DirectedGraph& topology, VertexId v, Reachability::Direction direction,
                std::vector<bool>* useful) {
  const bool upstream = direction == Reachability::Direction::kUpstream;
  (*useful)[v] = false;
  std::vector<VertexId> frontier = {v};
  while (!frontier.empty()) {
    const VertexId vertex = frontier.back();
    frontier.pop_back();
    for (const EdgeId edge : upstream ? topology.incoming(vertex) : topology.outgoing(vertex)) {
      const VertexId next = upstream ? topology.from(edge) : topology.to(edge);
      if (!topology.removed(edge) && (*useful)[next]) {
        (*useful)[next] = false;
        frontier.push_back(next);
      }
    }
  }
}

}  // namespace

NonholonomicExploration::NonholonomicExploration(const NonholonomicAction& action, int index,
                                                 const ExplorerContext& context)
    : ActionExploration(action, index, context),
      action_(action),
      tried_(Counter("growth tried")),
      rejected_(Counter("growth rejected")),
      refused_(Counter("growth stopped at removed edge")),
      not_lined_up_(Counter("growth not lined up")),
      made_(Counter("growth made")) {}

NewElements NonholonomicExploration::GrowTowards(const Point& p_target) {
  const PossibilityGraph& master = *context().master;
  SortedVertexQueue q_closest;
  for (const SubGraph& g : action_graph().SubGraphs()) {
    for (const VertexId v : g) {
      q_closest.Insert(context().space->Distance(master.point(v), p_target), v);
    }
  }
  NewElements found;
  Useful to_launch_from(master.topology().num_vertices(), true);
  Useful to_land_at = to_launch_from;
  int launches = 0;
  int landings = 0;
  while (!q_closest.empty() && !context().deadline->Passed()) {
    const VertexId v = q_closest.PopFront();
    if (launches < kMostPerGrowth && to_launch_from[v] && !master.UpstreamFromGoal(v) &&
        LaunchFrom(v, p_target, &found)) {
      RecursivelySetUpstreamVerticesToFalse(v, &to_launch_from);
      ++launches;
    }
    if (landings < kMostPerGrowth && to_land_at[v] && !master.DownstreamFromStart(v) &&
        LandAt(v, p_target, &found)) {
      RecursivelySetDownstreamVerticesToFalse(v, &to_land_at);
      ++landings;
    }
    if (launches == kMostPerGrowth && landings == kMostPerGrowth) {
      break;
    }
  }
  action_graph().Append(found);
  return found;
}

void NonholonomicExploration::CountTry() {
  ++*tried_;
  work_ += kWorkOfTry;
}

bool NonholonomicExploration::LaunchFrom(VertexId v, const Point& p_target, NewElements* found) {
  CountTry();
  const Point point = context().master->point(v);
  const std::optional<Point> launch = action_.FindLaunchPoint(point, p_target);
  if (!launch) {
    return false;
  }
  const Edge edge = {*launch, action_.ExtendTowards(*launch, p_target)};
  if (SamePoint(point, *launch)) {
    return IsExplorable(edge) && AppendEdges(edge, std::nullopt, found);
  }
  return IsExplorable(edge) && AppendEdges(edge, Edge{point, *launch}, found);
}

bool NonholonomicExploration::LandAt(VertexId v, const Point& p_target, NewElements* found) {
  CountTry();
  const Point point = context().master->point(v);
  const std::optional<Point> landing = action_.FindLandingPoint(point, p_target);
  if (!landing) {
    return false;
  }
  const Edge edge = {action_.ReverseExtend(*landing, p_target), *landing};
  if (SamePoint(*landing, point)) {
    return IsExplorable(edge) && AppendEdges(edge, std::nullopt, found);
  }
  return IsExplorable(edge) && AppendEdges(edge, Edge{*landing, point}, found);
}

bool NonholonomicExploration::IsExplorable(const Edge& edge) {
  const bool explorable = !SamePoint(edge.from, edge.to) && action_.Explorable(edge.from) &&
                          action_.Explorable(edge.to) && action_.Explorable(edge);
  *rejected_ += !explorable;
  return explorable;
}

std::optional<int> NonholonomicExploration::WhoLinesUp(const Edge& line_up) const {
  const PossibilityGraph& master = *context().master;
  const std::optional<VertexId> from = master.FindVertexAt(line_up.from);
  const std::optional<VertexId> to = master.FindVertexAt(line_up.to);
  for (int a = 0; a < static_cast<int>(context().actions->size()); ++a) {
    const Action& other = *(*context().actions)[a];
    const bool was_removed = from && to && WasRemoved(a, *from, *to);
    if (a != index() && !was_removed && other.Explorable(line_up.from) &&
        other.Explorable(line_up.to) && other.Explorable(line_up)) {
      return a;
    }
  }
  return std::nullopt;
}

bool NonholonomicExploration::AppendEdges(const Edge& edge, const std::optional<Edge>& line_up,
                                          NewElements* found) {
  PossibilityGraph& master = *context().master;
  const std::optional<VertexId> from = master.FindVertexAt(edge.from);
  const std::optional<VertexId> to = master.FindVertexAt(edge.to);
  if (from && to && WasRemoved(*from, *to)) {
    ++*refused_;
    return false;
  }
  int neighbour = index();
  if (line_up) {
    const std::optional<int> other = WhoLinesUp(*line_up);
    if (!other) {
      ++*not_lined_up_;
      return false;
    }
    neighbour = *other;
  }
  const VertexId v_launch = AppendVertex(edge.from, found);
  const VertexId v_landing = AppendVertex(edge.to, found);
  found->edges.push_back({v_launch, v_landing, action_.IsReversible()});
  if (line_up) {
    const bool reversible = (*context().actions)[neighbour]->IsReversible();
    const NewEdge way = {master.VertexAt(line_up->from), master.VertexAt(line_up->to), reversible};
    found->line_ups.push_back({neighbour, way});
  }
  ++*made_;
  return true;
}

VertexId NonholonomicExploration::AppendVertex(const Point& point, NewElements* found) {
  const VertexId vertex = context().master->VertexAt(point);
  if (!action_graph().Contains(vertex)) {
    found->vertices.push_back(vertex);
    found->offered.push_back(vertex);
  }
  return vertex;
}

void NonholonomicExploration::RecursivelySetUpstreamVerticesToFalse(VertexId v,
                                                                    Useful* useful) const {
  SetToFalse(context().master->topology(), v, Reachability::Direction::kUpstream, useful);
}

void NonholonomicExploration::RecursivelySetDownstreamVerticesToFalse(VertexId v,
                                                                      Useful* useful) const {
  SetToFalse(context().master->topology(), v, Reachability::Direction::kDownstream, useful);
}

}  // namespace possibility::graph
