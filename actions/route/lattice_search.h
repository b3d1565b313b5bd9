#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <queue>
#include <unordered_set>
#include <vector>

#include "actions/route/route_space.h"
#include "common/cancellation_token.h"
#include "graph/structure/path_edge.h"

namespace possibility::actions {

struct LatticeSettings {
  double step = 0.3;                  ///< m, between neighbouring stances
  int headings = 16;                  ///< number of headings on the circle
  double greed = 2;                   ///< weight of the remaining distance; 1: shortest routes
  std::int64_t most_stances = 20000;  ///< examined before the search gives up
};

/// Searches for a route from a start to any of several goals. Every stance, straight way and
/// transition on it meets C_S, and every edge of a manoeuvre is explorable. Weighted hybrid A*
/// (Dolgov, Thrun, Montemerlo & Diebel 2010) over gait, place and heading; strides are the
/// primitives, and ways are tested lazily. Actions are numbered as in the planner: gaits, then
/// manoeuvres. Failure proves nothing.
class LatticeSearch {
 public:
  enum class Status { kSearching, kFound, kGivenUp };

  LatticeSearch(const RouteSpace& space, const GroundedStance& start,
                const std::vector<GroundedStance>& goals, const LatticeSettings& settings);

  /// Examines `stances` more stances, or fewer if the search ends. Asks
  /// `cancellation` at every stance; once cancelled, returns at once.
  Status Advance(std::int64_t stances, const CancellationToken& cancellation);

  /// The route, if found.
  std::vector<graph::PathEdge> Route() const { return RouteToNode(found_); }

  /// Stances reached so far, in the order of the search. Manoeuvres that lead there may still be
  /// refuted.
  std::vector<GroundedStance> Reached() const;
  /// Whether that is all there is, and not what `most_stances` allowed.
  bool IsThrough() const { return open_.empty(); }
  /// Expected duration of the route to one of them: an index into Reached(); s.
  double TimeTo(int reached) const { return nodes_[reached_[reached]].cost; }
  /// That route.
  std::vector<graph::PathEdge> RouteTo(int reached) const { return RouteToNode(reached_[reached]); }

  /// Ignores routes that take this long or longer, s.
  void SetBound(double duration) { bound_ = duration; }

  /// Least distance from any reached stance to any goal, m.
  double closest_approach() const { return closest_approach_; }

  /// Lower bound of the expected duration of any route on this lattice, s: the least cost of an
  /// unexpanded node plus the quickest gait's time for the remaining distance. 0 with manoeuvres,
  /// which may be quicker than gaits. For a greed of 1.
  double LowerBound() const;

 private:
  /// Directions of strides: straight ahead first.
  static constexpr int kNone = -1;
  static constexpr int kAhead = 0;

  struct Node {
    GroundedStance stance;
    int parent = -1;
    int action = 0;    ///< leads here from the parent
    double cost = 0;   ///< s
    int halvings = 0;  ///< of the stride that leads here
    bool is_goal = false;
    int direction = kNone;  ///< of the stride that leads here
  };
  struct Candidate {
    double priority = 0;
    int node = 0;
    bool launches = false;  ///< the manoeuvres' turn at the node
    bool operator<(const Candidate& other) const {
      return priority != other.priority ? priority > other.priority : node > other.node;
    }
  };

  graph::Point PointOf(const GroundedStance& stance) const;
  int num_gaits() const { return static_cast<int>(space_.gaits->size()); }
  const SearchedManoeuvre& ManoeuvreOf(int action) const {
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
  bool Launches(const SearchedManoeuvre& manoeuvre, const graph::Point& v,
                const graph::Point& end) const;
  std::vector<graph::Point> Landings(int node, const SearchedManoeuvre& manoeuvre) const;
  std::size_t EndOfStraight(const std::vector<int>& way, std::size_t first) const;
  graph::PathEdge EdgeBetween(int from, int to) const;
  std::vector<graph::PathEdge> RouteToNode(int node) const;

  RouteSpace space_;
  std::vector<GroundedStance> goals_;
  LatticeSettings settings_;
  std::vector<double> stop_times_;  ///< s, by gait: after strides in one direction
  double least_seconds_per_metre_ = std::numeric_limits<double>::infinity();
  double bound_ = std::numeric_limits<double>::infinity();
  double closest_approach_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::priority_queue<Candidate> open_;
  std::unordered_set<std::int64_t> closed_;
  std::vector<int> reached_;  ///< nodes
  std::int64_t examined_ = 0;
  int found_ = -1;  ///< node
};

}  // namespace possibility::actions
