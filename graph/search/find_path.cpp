#include "graph/search/find_path.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>

#include "common/deadline.h"
#include "graph/confirmation/confirmation_turns.h"
#include "graph/search/exploration.h"
#include "graph/search/find_path_arguments.h"
#include "graph/search/path_confirmation.h"
#include "graph/search/random_explorer.h"
#include "graph/search/straight_path.h"
#include "graph/structure/possibility_graph.h"

namespace possibility::graph {
namespace {

/// Tolerance for durations that are summed in different orders, s.
constexpr double kSameDuration = 1e-9;

/// Extra wait for jobs that may improve a confirmed path, s.
constexpr double kPatience = 0.1;

/// Time that jobs on threads get before the oracle is asked beside them, s.
constexpr double kHeadStart = 1;

std::vector<ExplorerFactory> ExplorersOf(const FindPathSettings& settings) {
  return settings.explorers.empty() ? std::vector<ExplorerFactory>{RandomExploration()}
                                    : settings.explorers;
}

/// Algorithm 1.
class PathFinder {
 public:
  PathFinder(const Point& start, const std::vector<Point>& goals,
             const std::vector<std::shared_ptr<const Action>>& actions,
             const ExplorationSpace& space, const FindPathSettings& settings,
             const Deadline& deadline, PathResult* result)
      : settings_(settings),
        deadline_(deadline),
        result_(*result),
        generator_(settings.seed),
        master_(actions, &space, start, goals),
        q_confirmation_({.job_time_limit = settings.confirmation_job_limit}),
        turns_(&q_confirmation_),
        confirmation_(actions, &master_, &q_confirmation_, &deadline_, &result_.counters),
        exploration_({.actions = &actions,
                      .space = &space,
                      .settings = &settings,
                      .master = &master_,
                      .generator = &generator_,
                      .deadline = &deadline,
                      .counters = &result_.counters},
                     ExplorersOf(settings), &confirmation_) {}

  /// Starts with a known path, as GoStraight returns it.
  void StartWith(const PathResult& known) {
    exploration_.AppendRoute(known.path, known.found_by.front());
    FindConfirmedPath();
  }

  void FindPath() {
    q_confirmation_.LaunchThreads(settings_.confirmation_threads);
    while (!deadline_.Passed() && !Answered() && !ImprovementIsOver()) {
      CollectResults();
      if (!ExplorationIsOver()) {
        exploration_.Explore(stage());
        ++cycles_;
      } else if (q_confirmation_.num_open() == 0) {
        // What the last jobs confirmed may complete a path.
        const bool was_found = best_.has_value();
        FindConfirmedPath();
        if (q_confirmation_.num_open() == 0 && best_.has_value() == was_found) {
          if (result_.counters.count(kEffortIsSpent) > 0) result_.status = PathStatus::kExhausted;
          break;
        }
        continue;
      } else {
        q_confirmation_.WaitForResult(MaxWait());
      }
      FindConfirmedPath();
      if (settings_.confirmation_threads == 0 && !ImprovementIsOver()) {
        RunConfirmationTurn();
      }
      ReportProgress();
    }
    // The last turn may have confirmed a quicker path.
    CollectResults();
    if (best_) FindConfirmedPath();
    confirmation_.CancelJobs();
    CompleteResult();
  }

 private:
  /// The quickest confirmed path so far.
  struct Incumbent {
    int goal = 0;
    std::vector<EdgeId> path;
    double duration = 0;
  };

  SearchStage stage() const { return best_ ? SearchStage::kImprovement : SearchStage::kFirstRoute; }

  void CollectResults() {
    confirmation_.CollectResults();
    if (confirmation_.num_refuted() > refuted_) {
      refuted_ = confirmation_.num_refuted();
      exploration_.OnRefuted();
    }
  }

  /// Tries to confirm the shortest path to any goal, until one is confirmed: it is the best answer
  /// so far. Edges that fail are out of the graph and handed to jobs.
  void FindConfirmedPath() {
    while (!deadline_.Passed()) {
      std::optional<Incumbent> shortest = ShortestPathToAnyGoal();
      if (!shortest) return;
      best_route_seconds_ = shortest->duration;
      if (best_ && shortest->duration >= best_->duration - kSameDuration) return;
      if (confirmation_.ConfirmPath(shortest->path)) {
        SetBest(std::move(*shortest));
        return;
      }
    }
  }

  std::optional<Incumbent> ShortestPathToAnyGoal() const {
    std::optional<Incumbent> shortest;
    for (std::size_t g = 0; g < master_.goals().size(); ++g) {
      if (!master_.Connected(master_.goals()[g])) continue;
      auto path = master_.ShortestPath(master_.start(), master_.goals()[g]);
      if (!path) continue;
      const double duration = Duration(*path);
      if (!shortest || duration < shortest->duration) {
        shortest = {static_cast<int>(g), std::move(*path), duration};
      }
    }
    return shortest;
  }

  void SetBest(Incumbent path) {
    if (!best_) {
      result_.first_path_seconds = deadline_.Elapsed();
      result_.first_duration = path.duration;
    }
    best_ = std::move(path);
    if (settings_.improvement_share == 0) return;
    confirmation_.SetBound(best_->duration);
    exploration_.OnRoute(EdgesOf(best_->path), best_->duration);
  }

  double Duration(const std::vector<EdgeId>& path) const {
    double duration = 0;
    for (const EdgeId edge : path) {
      duration += master_.duration(edge);
    }
    return duration;
  }

  std::vector<PathEdge> EdgesOf(const std::vector<EdgeId>& path) const {
    std::vector<PathEdge> edges;
    edges.reserve(path.size());
    for (const EdgeId edge : path) {
      edges.push_back({master_.confirmed_by(edge), master_.points(edge),
                       master_.topology().from(edge), master_.topology().to(edge)});
    }
    return edges;
  }

  bool ExplorationIsOver() const {
    return (settings_.max_cycles >= 0 && cycles_ >= settings_.max_cycles) ||
           exploration_.IsOver(stage());
  }

  /// When nothing is left to explore, open jobs get one more turn, or as much time as the first
  /// path took. A small improvement is not worth a long wait.
  bool ImprovementIsOver() const {
    if (!best_) return false;
    if (ImprovementTime() <= 0) return true;
    if (!ExplorationIsOver()) return false;
    if (q_confirmation_.num_open() == 0) return true;
    return settings_.confirmation_threads > 0
               ? deadline_.Elapsed() > 2 * result_.first_path_seconds + kPatience
               : last_turn_is_over_;
  }

  /// Time left for improvement, s.
  double ImprovementTime() const {
    const double share = settings_.improvement_share * settings_.time_limit;
    return result_.first_path_seconds + share - deadline_.Elapsed();
  }

  void RunConfirmationTurn() {
    if (!best_) {
      turns_.RunTurnIfDue(exploration_.work(), ExplorationIsOver(), deadline_);
      return;
    }
    const bool is_last = ExplorationIsOver();
    turns_.RunTurnIfDue(exploration_.work(), is_last,
                        Deadline(std::min(ImprovementTime(), deadline_.Remaining())));
    last_turn_is_over_ = is_last;
  }

  /// Asks the oracle if it is due. True if its answer ends the search.
  bool Answered() {
    if (oracle_asked_ || best_ || !settings_.oracle || !OracleIsDue()) {
      return false;
    }
    oracle_asked_ = true;
    switch (settings_.oracle()) {
      case RouteOracleAnswer::kProvenInfeasible:
        result_.status = PathStatus::kProvenInfeasible;
        return true;
      case RouteOracleAnswer::kExhausted:
        result_.status = PathStatus::kExhausted;
        return true;
      case RouteOracleAnswer::kUnknown:
        exploration_.OnUndecided();
        break;
    }
    return false;
  }

  bool OracleIsDue() {
    const bool jobs_are_open = q_confirmation_.num_open() > 0;
    if (exploration_.SomebodyIsThrough(stage()) && !jobs_are_open) return true;
    if (cycles_ < settings_.ask_oracle_after) return false;
    return settings_.confirmation_threads == 0 || !jobs_are_open || HeadStartIsOver();
  }

  /// Cycles pass quickly beside jobs on threads. No result is collected while the oracle searches,
  /// so jobs that are nearly done come first.
  bool HeadStartIsOver() {
    if (!head_start_began_) head_start_began_ = deadline_.Elapsed();
    return deadline_.Elapsed() - *head_start_began_ >= kHeadStart;
  }

  /// Without threads no result can arrive during a wait.
  std::chrono::milliseconds MaxWait() const {
    return std::chrono::milliseconds(settings_.confirmation_threads > 0 ? 10 : 0);
  }

  FindPathProgress Progress() const {
    return {.seconds = deadline_.Elapsed(),
            .cycles = static_cast<int>(cycles_),
            .vertices = master_.topology().num_vertices(),
            .edges = master_.topology().num_edges(),
            .jobs = confirmation_.num_jobs(),
            .best_route_seconds = best_route_seconds_};
  }

  void ReportProgress() {
    constexpr double kInterval = 0.1;  // s
    if (settings_.progress && deadline_.Elapsed() >= next_progress_) {
      next_progress_ = deadline_.Elapsed() + kInterval;
      settings_.progress(Progress());
    }
  }

  void CompleteResult() {
    result_.statistics = Progress();
    result_.seconds = result_.statistics.seconds;
    result_.confirmations = confirmation_.TakeReports();
    if (best_) SetFound();
    const DirectedGraph& topology = master_.topology();
    for (VertexId vertex = 0; vertex < topology.num_vertices(); ++vertex) {
      result_.graph.vertices.push_back(master_.point(vertex));
    }
    for (EdgeId edge = 0; edge < topology.num_edges(); ++edge) {
      if (!topology.removed(edge)) {
        result_.graph.edges.push_back(
            {topology.from(edge), topology.to(edge), master_.action(edge)});
      }
    }
  }

  void SetFound() {
    result_.status = PathStatus::kFound;
    result_.goal = best_->goal;
    result_.duration = best_->duration;
    result_.lower_bound = std::min(exploration_.lower_bound(), best_->duration);
    result_.path = EdgesOf(best_->path);
    for (const EdgeId edge : best_->path) {
      const std::string& name = exploration_.found_by(edge);
      if (std::find(result_.found_by.begin(), result_.found_by.end(), name) ==
          result_.found_by.end()) {
        result_.found_by.push_back(name);
      }
    }
  }

  const FindPathSettings& settings_;
  const Deadline& deadline_;
  PathResult& result_;
  RandomGenerator generator_;
  PossibilityGraph master_;
  ConfirmationQueue q_confirmation_;
  ConfirmationTurns turns_;
  PathConfirmation confirmation_;
  Exploration exploration_;
  std::optional<Incumbent> best_;
  std::int64_t cycles_ = 0;
  int refuted_ = 0;
  bool oracle_asked_ = false;
  std::optional<double> head_start_began_;  ///< when the oracle became due beside jobs, s
  bool last_turn_is_over_ = false;
  double next_progress_ = 0;
  double best_route_seconds_ = 0;
};

}  // namespace

// keeps the code of a straight answer together and apart from the search: cold code
// would take longer than the answer itself (docs/performance.md).
PathResult FindPath(const Point& start, const std::vector<Point>& goals,
                    const std::vector<std::shared_ptr<const Action>>& actions,
                    const ExplorationSpace& space, const FindPathSettings& settings) {
  const Deadline deadline(settings.time_limit);
  CheckFindPathArguments(start, goals, actions, settings);
  PathResult straight;
  const bool is_straight =
      settings.straight_first && GoStraight(start, goals, actions, deadline, &straight);
  if (is_straight && settings.improvement_share == 0) return straight;
  PathResult result;
  PathFinder finder(start, goals, actions, space, settings, deadline, &result);
  if (is_straight) finder.StartWith(straight);
  finder.FindPath();
  return result;
}

}  // namespace possibility::graph
