#pragma once

#include <memory>
#include <optional>
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
  /// action has none, which refutes the edge. The job may outlive the call but not the action, and
  /// runs beside further calls to it.
  virtual std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const PointPair& edge) const = 0;

  /// What all conditions that one cycle of exploration asks of this action may take together, s in
  /// the mean. On one thread, jobs and exploration divide their time by it; who takes more than
  /// ten times as long is charged by the clock, and one seed is no longer one search.
  virtual double cycle_budget() const { return 1e-3; }
};

class HolonomicAction : public Action {
 public:
  /// A point on the action's condition manifold close to v.
  virtual Point Project(const Point& v) const = 0;
};

/// An action that has to line itself up first, such as a jump: its edges lead from a launch point
/// to a landing point. How the robot gets from a vertex to the launch point, and from the landing
/// point to a vertex, is the affair of the other actions: such line-up edges are theirs.
class NonholonomicAction : public Action {
 public:
  /// The point where an edge of this action from the launch point v0 lands: v1 if that is within
  /// reach and straight ahead, otherwise as close to it as the action gets. Whether such an edge
  /// is possible is asked of C_N.
  Point ExtendTowards(const Point& v0, const Point& v1) const override = 0;

  /// A point from which this action arrives at the landing point v0, as close to v1 as its reach
  /// allows.
  virtual Point ReverseExtend(const Point& v0, const Point& v1) const = 0;

  /// A point close to v that is fit for ExtendTowards(point, v1), to be reached from v by another
  /// action, or v itself (exactly); nothing if there is none.
  virtual std::optional<Point> FindLaunchPoint(const Point& v, const Point& v1) const = 0;

  /// A point close to v that is fit for ReverseExtend(point, v1), from which another action leads
  /// to v, or v itself (exactly); nothing if there is none.
  virtual std::optional<Point> FindLandingPoint(const Point& v, const Point& v1) const = 0;

  /// Nothing needs to be done to get from a vertex that meets C_N (one where the action can begin
  /// or end) into its condition manifold.
  std::vector<Point> TransitionFrom(const Point& v) const override {
    return Explorable(v) ? std::vector<Point>{v} : std::vector<Point>{};
  }

  bool IsReversible() const override { return false; }
};

}  // namespace possibility::graph
