#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/action.h"
#include "graph/action_graph.h"
#include "graph/explorer.h"
#include "graph/possibility_graph.h"
#include "graph/transition_queue.h"

namespace possibility::graph {

/// The exploring half of the paper's Action: one action together with its own graph Gamma_a and
/// its queue Q_Transition. How it grows depends on the kind of action.
class ActionExploration {
 public:
  /// `index` is the action's number in the master graph.
  ActionExploration(const Action& action, int index, const ExplorerContext& context);
  virtual ~ActionExploration() = default;
  ActionExploration(const ActionExploration&) = delete;
  ActionExploration& operator=(const ActionExploration&) = delete;

  /// Start or goal: part of Gamma_a if the action accepts it, to be transitioned from if not.
  void AddInitialVertex(VertexId vertex);

  /// Takes what another action found: its vertices to be transitioned from or, if they are offered
  /// and the action accepts them, into Gamma_a; line-up edges of this action into Gamma_a.
  void TakeOver(const NewElements& found_by_other);

  /// Algorithm 2. Appends to Gamma_a; appending to the master graph is left to the caller.
  NewElements PerformTransitions();

  /// Algorithm 3 or 4. Appends to Gamma_a; appending to the master graph is left to the caller.
  virtual NewElements GrowTowards(const Point& p_target) = 0;

  ActionGraph& action_graph() { return action_graph_; }

 protected:
  const Action& action() const { return action_; }
  int index() const { return index_; }
  const ExplorerContext& context() const { return context_; }

  bool SamePoint(const Point& a, const Point& b) const;
  /// Whether the master graph once held an edge of this action (or that of a given number) that
  /// is to be confirmed or was refuted.
  bool WasRemoved(VertexId from, VertexId to) const { return WasRemoved(index_, from, to); }
  bool WasRemoved(int action, VertexId from, VertexId to) const;
  /// The counter "<action>: <what>", which lives as long as the context.
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

/// The exploration that suits the kind of `action`.
/// @throws std::invalid_argument if its kind is unknown.
std::unique_ptr<ActionExploration> MakeActionExploration(const Action& action, int index,
                                                         const ExplorerContext& context);

}  // namespace possibility::graph
