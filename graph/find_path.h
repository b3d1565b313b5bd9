#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "graph/action.h"
#include "graph/confirmation_report.h"
#include "graph/exploration_space.h"

namespace possibility::graph {

/// One edge of a path: by which action, between which points.
struct PathEdge {
  int action = 0;
  PointPair points;
};

enum class PathStatus {
  kFound,             ///< every edge of the path is confirmed
  kProvenInfeasible,  ///< no path through C_N exists at the resolution asked (see RouteOracle)
  kExhausted,         ///< no path through what can be confirmed exists
  kTimeLimit,
};

/// What a search over the whole space (not a random one) can say about routes from the start to
/// any goal; asked once, after FindPathSettings::ask_oracle_after cycles without a path.
enum class RouteOracleAnswer { kUnknown, kProvenInfeasible, kExhausted };
using RouteOracle = std::function<RouteOracleAnswer()>;

struct FindPathProgress {
  double seconds = 0;
  int cycles = 0;
  int vertices = 0;
  int edges = 0;
  int jobs = 0;
  double best_route_seconds = 0;  ///< expected duration of the best candidate; 0 if none yet
};

struct FindPathSettings {
  double time_limit = 60;  ///< s
  std::uint64_t seed = 1;
  int max_transitions_per_cycle = 5;   ///< Algorithm 2
  int confirmation_threads = 0;        ///< 0: jobs run one by one between cycles, never beside them
  double confirmation_job_limit = 30;  ///< s that one job may run before it has failed
  std::int64_t max_cycles = -1;        ///< -1: until the time limit
  std::int64_t ask_oracle_after = 200;  ///< cycles
  RouteOracle oracle = {};              ///< may be empty
  /// Before anything else, every action is asked whether C_S lets it go straight from the start to
  /// a goal; one that does is the path, and nothing is explored.
  bool straight_first = false;
  /// A route that somebody who knows the space thinks worth exploring first: edges end to end from
  /// the start. What of it the actions accept becomes part of the graph. Asked before the first
  /// cycle, and again, a few times, when jobs have refuted edges since. May be empty, or give
  /// nothing; then the oracle is asked at once.
  std::function<std::vector<PathEdge>()> suggestion = {};
  /// Per name of an action: with what probability a cycle grows it not (paper: 0.9 for jumping).
  std::map<std::string, double> skip_growth = {};
  std::function<void(const FindPathProgress&)> progress = {};  ///< called at most 10 times a second
};

/// The explored graph as a value, for reports and pictures.
struct GraphSnapshot {
  struct Edge {
    int from = 0;
    int to = 0;
    int action = 0;
  };
  std::vector<Point> vertices;
  std::vector<Edge> edges;
};

struct PathResult {
  PathStatus status = PathStatus::kTimeLimit;
  std::vector<PathEdge> path;  ///< from the start to a goal, if kFound
  int goal = -1;               ///< index of the goal reached
  double seconds = 0;
  FindPathProgress statistics;
  std::map<std::string, std::int64_t> counters;   ///< what was tried and rejected, by name
  std::vector<ConfirmationReport> confirmations;  ///< jobs that ended, in that order
  GraphSnapshot graph;
};

/// Algorithm 1: explores the possibilities of `actions` from `start` until a path to one of
/// `goals` is confirmed, nothing is left to try, or time is up.
/// @throws std::invalid_argument if there is no action or no goal, an action is null or of a kind
/// that FindPath cannot grow, the points differ in size or are not finite, a setting is out of
/// range or names an unknown action, or an expected duration is negative or not finite.
PathResult FindPath(const Point& start, const std::vector<Point>& goals,
                    const std::vector<std::shared_ptr<const Action>>& actions,
                    const ExplorationSpace& space, const FindPathSettings& settings);

}  // namespace possibility::graph
