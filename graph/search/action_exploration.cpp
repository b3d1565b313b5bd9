#include "graph/search/action_exploration.h"

#include <stdexcept>

#include "graph/search/find_path.h"
#include "graph/search/holonomic_exploration.h"
#include "graph/search/nonholonomic_exploration.h"

namespace possibility::graph {

ActionExploration::ActionExploration(const Action& action, int index,
                                     const ExplorerContext& context)
    : action_(action),
      index_(index),
      context_(context),
      action_graph_(index, context.master),
      transitions_made_(Counter("transition made")),
      transitions_failed_(Counter("transition failed")) {}

void ActionExploration::AddInitialVertex(VertexId vertex) {
  if (action_.Explorable(context_.master->point(vertex))) {
    action_graph_.Append({.vertices = {vertex}});
  } else {
    transition_queue_.Insert(vertex);
  }
}

void ActionExploration::TakeOver(const NewElements& found_by_other) {
  for (const LineUpEdge& line_up : found_by_other.line_ups) {
    if (line_up.action == index_) {
      const NewEdge& edge = line_up.edge;
      action_graph_.Append({.vertices = {edge.from, edge.to}, .edges = {edge}});
    }
  }
  for (const VertexId vertex : found_by_other.offered) {
    if (!action_graph_.Contains(vertex)) {
      AddInitialVertex(vertex);
    }
  }
  InsertIntoTransitionQueue(found_by_other.vertices);
}

void ActionExploration::InsertIntoTransitionQueue(const std::vector<VertexId>& vertices) {
  for (const VertexId vertex : vertices) {
    if (!action_graph_.Contains(vertex)) {
      transition_queue_.Insert(vertex);
    }
  }
}

NewElements ActionExploration::PerformTransitions() {
  NewElements found;
  for (int i = 0; i < context_.settings->max_transitions_per_cycle && !context_.deadline->Passed();
       ++i) {
    const auto v = transition_queue_.PopRandom(context_.generator);
    if (!v) {
      break;
    }
    found.Append(TransitionFrom(*v));
  }
  action_graph_.Append(found);
  return found;
}

NewElements ActionExploration::TransitionFrom(VertexId v) {
  PossibilityGraph& master = *context_.master;
  const std::vector<Point> path = action_.TransitionFrom(master.point(v));
  NewElements found;
  if (path.empty() || !action_.Explorable(path.back())) {
    ++*transitions_failed_;
    return found;
  }
  ++*transitions_made_;
  VertexId last = v;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const VertexId next = master.VertexAt(path[i]);
    if (next != last) {
      found.edges.push_back({last, next, action_.IsReversible()});
    }
    const bool accepted = i + 1 == path.size() || action_.Explorable(path[i]);
    if (accepted && !action_graph_.Contains(next)) {
      found.vertices.push_back(next);
    }
    last = next;
  }
  return found;
}

bool ActionExploration::SamePoint(const Point& a, const Point& b) const {
  return context_.space->Distance(a, b) < kSamePointDistance;
}

bool ActionExploration::WasRemoved(int action, VertexId from, VertexId to) const {
  const auto edge = context_.master->FindEdge(action, from, to);
  return edge && context_.master->topology().removed(*edge);
}

std::int64_t* ActionExploration::Counter(const std::string& what) const {
  return &(*context_.counters)[action_.name() + ": " + what];
}

std::unique_ptr<ActionExploration> MakeActionExploration(const Action& action, int index,
                                                         const ExplorerContext& context) {
  if (const auto* holonomic = dynamic_cast<const HolonomicAction*>(&action)) {
    return std::make_unique<HolonomicExploration>(*holonomic, index, context);
  }
  if (const auto* nonholonomic = dynamic_cast<const NonholonomicAction*>(&action)) {
    return std::make_unique<NonholonomicExploration>(*nonholonomic, index, context);
  }
  throw std::invalid_argument("action " + action.name() +
                              ": expected a HolonomicAction or a NonholonomicAction");
}

}  // namespace possibility::graph
