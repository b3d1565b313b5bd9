#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/confirmation_job.h"
#include "graph/exploration_space.h"

namespace possibility::graph {

/// A directed edge of E, from one point to another.
struct PointPair {
  Point from;
  Point to;
};

/// Table 1 of the paper, the functions that every action engineers. Implementations are
/// deterministic: the same arguments give the same answer.
class Action {
 public:
  virtual ~Action() = default;

  virtual std::string name() const = 0;

  /// A point reached by moving from v0 towards v1 by this action; v1 itself (exactly) if it is
  /// within one step.
  virtual Point ExtendTowards(const Point& v0, const Point& v1) const = 0;

  /// Necessary conditions: false only if the action is impossible there.
  virtual bool CN(const Point& vertex) const = 0;
  virtual bool CN(const PointPair& edge) const = 0;

  /// Sufficient conditions: true only if the action certainly succeeds there. An edge may be an
  /// extension of this action or a transition into it.
  virtual bool CS(const Point& vertex) const = 0;
  virtual bool CS(const PointPair& edge) const = 0;

  /// Whether exploration may append `x`. The paper's C_N by default; actions whose confirmation
  /// jobs decide nothing return C_S, as the paper's own experiments do (its Limitations).
  virtual bool Explorable(const Point& vertex) const { return CN(vertex); }
  virtual bool Explorable(const PointPair& edge) const { return CN(edge); }

  /// Points after `v` of a path from v into this action's condition manifold; empty if none.
  virtual std::vector<Point> TransitionFrom(const Point& v) const = 0;

  /// Whether every edge of this action can also be executed in the opposite direction.
  virtual bool IsReversible() const = 0;

  /// Expected execution time of an edge, s: the weight of ShortestPath.
  virtual double ExpectedDuration(const PointPair& edge) const = 0;

  /// A job that finds out whether an edge that meets only C_N is truly feasible; null if this
  /// action has none, which refutes the edge.
  virtual std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const PointPair& edge) const = 0;
};

class HolonomicAction : public Action {
 public:
  /// A point on the action's condition manifold close to v.
  virtual Point Project(const Point& v) const = 0;
};

}  // namespace possibility::graph
