#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "graph/action/action.h"
#include "graph/action/exploration_space.h"
#include "graph/confirmation/confirmation_report.h"
#include "graph/search/explorer.h"
#include "graph/structure/path_edge.h"

namespace possibility::graph {

enum class PathStatus {
  kFound,             ///< every edge of the path is confirmed
  kProvenInfeasible,  ///< no path through C_N exists at the requested resolution (see RouteOracle)
  kExhausted,         ///< no path exists through what can be confirmed, or none was found with the
                      ///< effort of FindPathSettings::turns_after_oracle
  kTimeLimit,
};

/// The verdict of a search over the whole space (not a random one) on routes from the start to any
/// goal. Asked at most once, see FindPathSettings::ask_oracle_after.
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
  /// Explorers, in the order of their turns. Empty: the paper's exploration (RandomExploration).
  std::vector<ExplorerFactory> explorers = {};
  int max_transitions_per_cycle = 5;   ///< Algorithm 2
  int confirmation_threads = 0;        ///< 0: jobs run one by one between cycles, never beside them
  double confirmation_job_limit = 30;  ///< s that a job may run before it counts as failed
  std::int64_t max_cycles = -1;        ///< -1: until the time limit
  /// Random exploration ends when Gamma_PG has this many vertices and edges together. A million
  /// takes about half a GB.
  std::int64_t max_graph_size = 2'500'000;
  /// The oracle is asked after this many cycles without a confirmed path, or as soon as an explorer
  /// has nothing left to explore while no job is open. Open jobs on threads first get one second.
  std::int64_t ask_oracle_after = 200;
  RouteOracle oracle = {};  ///< may be empty
  /// Turns of random exploration after an oracle that could not tell; -1: until the time limit.
  std::int64_t turns_after_oracle = -1;
  /// First tests C_S of the straight edge from the start to each goal with every action. If it
  /// holds, that edge is the first path.
  bool straight_first = false;
  /// Share of the time limit that may be spent on a quicker path once a path is confirmed, with the
  /// explorers that take part in this stage. The search ends earlier if no quicker path is left to
  /// find.
  double improvement_share = 0;
  /// Per action name: probability that a cycle does not grow the action (paper: 0.9 for jumping).
  std::map<std::string, double> skip_growth = {};
  std::function<void(const FindPathProgress&)> progress = {};  ///< called at most 10 times a second
};

/// The explored graph as plain data, for reports and pictures.
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
  /// If kFound, a path from the start to a goal: the one in `graph` with the least expected
  /// duration, unless time ran out.
  std::vector<PathEdge> path;
  std::vector<std::string> found_by;  ///< explorers that found the edges of `path`, each once
  int goal = -1;                      ///< index of the goal reached
  double seconds = 0;                 ///< duration of the whole search
  double first_path_seconds = 0;      ///< time until the first path was confirmed
  double first_duration = 0;          ///< expected duration of the first path, s
  double duration = 0;                ///< expected duration of `path`, s
  /// Lower bound of the expected duration of all paths in `graph` and all paths considered by
  /// explorers that know a bound, s; 0 if no explorer knows one.
  double lower_bound = 0;
  FindPathProgress statistics;
  Counters counters;                              ///< attempts and rejections, by name
  std::vector<ConfirmationReport> confirmations;  ///< jobs that ended, in the order they ended
  GraphSnapshot graph;
};

/// Algorithm 1: explores the possibilities of `actions` from `start` until a path to one of `goals`
/// is confirmed, nothing is left to try, or time is up.
/// @throws std::invalid_argument if there is no action or no goal; if an action is null or of a
/// kind that the explorers cannot grow; if the points differ in size or are not finite; if a
/// setting is out of range or names an unknown action; or if an expected duration is negative or
/// not finite.
PathResult FindPath(const Point& start, const std::vector<Point>& goals,
                    const std::vector<std::shared_ptr<const Action>>& actions,
                    const ExplorationSpace& space, const FindPathSettings& settings);

}  // namespace possibility::graph
