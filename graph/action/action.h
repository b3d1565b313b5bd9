#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/action/confirmation_job.h"
#include "graph/action/exploration_space.h"

namespace possibility::graph {

/// A directed edge of E, from one point to another.
struct Edge {
  Point from;
  Point to;
};

/// The functions that every action implements (Table 1 of the paper). They are deterministic: the
/// same arguments give the same answer.
class Action {
 public:
  virtual ~Action() = default;

  virtual std::string name() const = 0;

  /// The point reached by moving from v0 towards v1 with this action. Returns v1 exactly if it is
  /// within one step.
  virtual Point ExtendTowards(const Point& v0, const Point& v1) const = 0;

  /// Necessary conditions: false only if the action is impossible there.
  virtual bool CN(const Point& vertex) const = 0;
  virtual bool CN(const Edge& edge) const = 0;

  /// Sufficient conditions: true only if the action certainly succeeds there. An edge may be an
  /// extension of this action or a transition into it.
  virtual bool CS(const Point& vertex) const = 0;
  virtual bool CS(const Edge& edge) const = 0;

  /// Whether exploration may append the vertex or edge. By default C_N, as in the paper. Actions
  /// whose confirmation jobs decide nothing return C_S, as the paper's experiments do (see its
  /// Limitations).
  virtual bool Explorable(const Point& vertex) const { return CN(vertex); }
  virtual bool Explorable(const Edge& edge) const { return CN(edge); }

  /// The points after `v` on a path from `v` into this action's condition manifold; empty if there
  /// is none.
  virtual std::vector<Point> TransitionFrom(const Point& v) const = 0;

  /// Whether every edge of this action can also be executed in the opposite direction.
  virtual bool IsReversible() const = 0;

  /// Expected execution time of an edge, s: the weight of ShortestPath.
  virtual double ExpectedDuration(const Edge& edge) const = 0;

  /// A job that decides whether an edge that meets only C_N is feasible. Null if this action has no
  /// such job; the edge is then refuted. The job may outlive the call but not the action, and runs
  /// concurrently with further calls to the action.
  virtual std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const Edge& edge) const = 0;

  /// Mean time budget, s, of all condition checks of this action in one exploration cycle. On a
  /// single thread, jobs and exploration divide their time by it. If exploration takes more than
  /// ten times its budget, measured time counts instead; the search then depends on the clock and
  /// not only on the seed.
  virtual double cycle_budget() const { return 1e-3; }
};

class HolonomicAction : public Action {
 public:
  /// A point on the action's condition manifold close to v.
  virtual Point Project(const Point& v) const = 0;
};

/// An action that must line up first, such as a jump. Its edges lead from a launch point to a
/// landing point. Other actions take the robot from a vertex to the launch point and from the
/// landing point to a vertex; these line-up edges belong to them.
class NonholonomicAction : public Action {
 public:
  /// The point where an edge of this action from the launch point v0 lands: v1 if it is within
  /// reach and straight ahead, otherwise the point closest to v1 that the action reaches. C_N
  /// decides whether such an edge is possible.
  Point ExtendTowards(const Point& v0, const Point& v1) const override = 0;

  /// The launch point from which this action lands at v0, as close to v1 as its reach allows.
  virtual Point ReverseExtend(const Point& v0, const Point& v1) const = 0;

  /// A point close to v that is fit for ExtendTowards(point, v1): v itself (exactly), or a point
  /// that another action reaches from v. Nothing if there is none.
  virtual std::optional<Point> FindLaunchPoint(const Point& v, const Point& v1) const = 0;

  /// A point close to v that is fit for ReverseExtend(point, v1): v itself (exactly), or a point
  /// from which another action reaches v. Nothing if there is none.
  virtual std::optional<Point> FindLandingPoint(const Point& v, const Point& v1) const = 0;

  /// A vertex that meets C_N (the action can begin or end there) is already in the condition
  /// manifold.
  std::vector<Point> TransitionFrom(const Point& v) const override {
    return Explorable(v) ? std::vector<Point>{v} : std::vector<Point>{};
  }

  bool IsReversible() const override { return false; }
};

}  // namespace possibility::graph
