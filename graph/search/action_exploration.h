#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/action/action.h"
#include "graph/search/explorer.h"
#include "graph/search/transition_queue.h"
#include "graph/structure/action_graph.h"
#include "graph/structure/possibility_graph.h"

namespace possibility::graph {

/// The exploring half of the paper's Action: one action with its own graph Gamma_a and its queue
/// Q_Transition. Subclasses define how the graph grows.
class ActionExploration {
 public:
  /// `index` is the action's number in the master graph.
  ActionExploration(const Action& action, int index, const ExplorerContext& context);
  virtual ~ActionExploration() = default;
  ActionExploration(const ActionExploration&) = delete;
  ActionExploration& operator=(const ActionExploration&) = delete;

  /// Adds the start or a goal: to Gamma_a if the action accepts it, otherwise to the transition
  /// queue.
  void AddInitialVertex(VertexId vertex);

  /// Takes over what another action found. Line-up edges of this action enter Gamma_a, and so do
  /// offered vertices that this action accepts. All other vertices enter the transition queue.
  void TakeOver(const NewElements& found_by_other);

  /// Algorithm 2. Appends to Gamma_a; the caller appends to the master graph.
  NewElements PerformTransitions();

  /// Algorithm 3 or 4. Appends to Gamma_a; the caller appends to the master graph.
  virtual NewElements GrowTowards(const Point& p_target) = 0;

  /// Declared work of all growth so far beyond the action's cycle_budget, s.
  virtual double growth_work() const { return 0; }

  ActionGraph& action_graph() { return action_graph_; }

 protected:
  const Action& action() const { return action_; }
  int index() const { return index_; }
  const ExplorerContext& context() const { return context_; }

  bool SamePoint(const Point& a, const Point& b) const;
  /// Whether an edge of this action (or of `action`) was removed from the master graph, to be
  /// confirmed or because it was refuted.
  bool WasRemoved(VertexId from, VertexId to) const { return WasRemoved(index_, from, to); }
  bool WasRemoved(int action, VertexId from, VertexId to) const;
  /// The counter "<action>: <what>". Valid as long as the context.
  std::int64_t* Counter(const std::string& what) const;

 private:
  void InsertIntoTransitionQueue(const std::vector<VertexId>& vertices);
  NewElements TransitionFrom(VertexId v);

  const Action& action_;
  int index_;
  ExplorerContext context_;
  ActionGraph action_graph_;
  TransitionQueue transition_queue_;
  std::int64_t* transitions_made_;
  std::int64_t* transitions_failed_;
};

/// Makes the exploration for the kind of `action`.
/// @throws std::invalid_argument if the kind is unknown.
std::unique_ptr<ActionExploration> MakeActionExploration(const Action& action, int index,
                                                         const ExplorerContext& context);

}  // namespace possibility::graph
