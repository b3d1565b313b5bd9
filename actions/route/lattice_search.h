#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <queue>
#include <unordered_set>
#include <vector>

#include "actions/route/route_space.h"
#include "graph/path_edge.h"

namespace possibility::actions {

struct LatticeSettings {
  double step = 0.3;                  ///< m, from stance to stance
  int headings = 16;                  ///< that the circle is divided into
  double greed = 2;                   ///< weight of the distance that is left; 1: shortest routes
  std::int64_t most_stances = 20000;  ///< examined, after which the search gives up
};

/// A search for a route from a start to any of several goals on which every stance meets C_S, every
/// straight way and every transition too, and every edge of a manoeuvre is worth a confirmation
/// job: weighted hybrid A* (Dolgov, Thrun, Montemerlo & Diebel 2010) over gait, place and heading,
/// with strides for primitives and ways tested only when their turn comes. Actions are numbered as
/// the planner does: gaits, then manoeuvres. That it finds none proves nothing.
class LatticeSearch {
 public:
  enum class Status { kSearching, kFound, kGivenUp };

  LatticeSearch(const RouteSpace& space, const GroundedStance& start,
                const std::vector<GroundedStance>& goals, const LatticeSettings& settings);

  /// Goes on until so many stances more are examined, or the search ends. `keep_going` (may be
  /// empty): asked at every stance; false returns at once.
  Status Advance(std::int64_t stances, const std::function<bool()>& keep_going);

  /// If found.
  std::vector<graph::PathEdge> Route() const;

  /// Routes that take as long or longer are not looked for any more, s.
  void SetBound(double duration) { bound_ = duration; }

  /// Least distance from any stance that was reached to any goal, m.
  double closest_approach() const { return closest_approach_; }

  /// No route on this lattice is expected to take less, s: the least cost of what is not expanded
  /// yet, with the time that the quickest gait takes for the distance that is left. 0 with
  /// manoeuvres, which may be quicker than gaits. For a greed of 1.
  double LowerBound() const;

 private:
  /// Of strides: straight ahead first.
  static constexpr int kNone = -1;
  static constexpr int kAhead = 0;

  struct Node {
    GroundedStance stance;
    int parent = -1;
    int action = 0;    ///< that leads here from the parent
    double cost = 0;   ///< s
    int halvings = 0;  ///< of the stride that leads here
    bool is_goal = false;
    int direction = kNone;  ///< of the stride that leads here
  };
  struct Candidate {
    double priority = 0;
    int node = 0;
    bool launches = false;  ///< whether it is the manoeuvres' turn there
    bool operator<(const Candidate& other) const {
      return priority != other.priority ? priority > other.priority : node > other.node;
    }
  };

  graph::Point PointOf(const GroundedStance& stance) const;
  int num_gaits() const { return static_cast<int>(space_.gaits->size()); }
  const Manoeuvre& ManoeuvreOf(int action) const {
    return *(*space_.manoeuvres)[action - num_gaits()];
  }
  double turn() const;
  std::int64_t CellOf(const Node& node) const;
  double DistanceLeft(const PlanarPose& pose) const;
  double TimeLeft(const PlanarPose& pose) const;
  double Patience(int gait) const;
  double StrideTime(int gait, const PlanarPose& displacement) const;
  double StopTime(int node, int direction) const;

  void Push(const Node& node);
  bool Offer(const Node& next);
  bool Offer(int node, const GroundedStance& next, int action, double duration);
  bool IsReached(int index);
  void Expand(int node);
  bool MayLaunch(int gait) const;
  void Halve(int blocked);
  void StrideTo(int node, int direction, const PlanarPose& displacement, int halvings);
  void Stride(int node);
  void Change(int node);
  void Finish(int node);
  void Manoeuvres(int node);
  void WalkTo(const graph::Point& launch, int node);
  graph::Point PointAhead(int node, double distance) const;
  bool Launches(const Manoeuvre& manoeuvre, const graph::Point& v, const graph::Point& end) const;
  std::vector<graph::Point> Landings(int node, const Manoeuvre& manoeuvre) const;
  std::size_t EndOfStraight(const std::vector<int>& way, std::size_t first) const;
  graph::PathEdge EdgeBetween(int from, int to) const;

  RouteSpace space_;
  std::vector<GroundedStance> goals_;
  LatticeSettings settings_;
  std::vector<double> stride_times_;  ///< s, by gait
  std::vector<double> stop_times_;    ///< s, by gait: after strides in one direction
  double least_seconds_per_metre_ = std::numeric_limits<double>::infinity();
  double bound_ = std::numeric_limits<double>::infinity();
  double closest_approach_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::priority_queue<Candidate> open_;
  std::unordered_set<std::int64_t> closed_;
  std::int64_t examined_ = 0;
  int found_ = -1;  ///< node
};

}  // namespace possibility::actions
