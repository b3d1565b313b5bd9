#include "graph/find_path.h"

#include <algorithm>
#include <utility>

#include "graph/action_exploration.h"
#include "graph/deadline.h"
#include "graph/find_path_arguments.h"
#include "graph/path_confirmation.h"
#include "graph/possibility_graph.h"
#include "graph/random.h"
#include "graph/straight_path.h"

namespace possibility::graph {
namespace {

constexpr int kMostSuggestions = 8;

/// What a turn in vain leaves to exploration: with DRC-HUBO1 about 0.5 s. (The turn: 3 s.)
constexpr std::int64_t kCyclesAfterTurnInVain = 1000;
/// A turn as many times as long is nearly what a job is given at all.
constexpr int kLongestTurn = 8;

/// Algorithm 1 at work.
class PathFinder {
 public:
  PathFinder(const Point& start, const std::vector<Point>& goals,
             const std::vector<std::shared_ptr<const Action>>& actions,
             const ExplorationSpace& space, const FindPathSettings& settings,
             const Deadline& deadline, PathResult* result)
      : settings_(settings),
        space_(space),
        actions_(actions),
        deadline_(deadline),
        result_(*result),
        generator_(settings.seed),
        master_(actions, &space, start, goals),
        q_confirmation_({.job_time_limit = settings.confirmation_job_limit}),
        confirmation_(actions, &master_, &q_confirmation_, &deadline_, &result_.counters) {
    InitializeActionGraphs();
  }

  [[gnu::noinline]] void FindPath() {
    q_confirmation_.LaunchThreads(settings_.confirmation_threads);
    while (!deadline_.Passed() && !Answered()) {
      confirmation_.CollectResults();
      if (SuggestionIsDue()) {
        ExploreSuggestion();
      } else if (!ExplorationIsOver()) {
        Explore();
        ++cycles_;
      } else if (q_confirmation_.num_open() == 0) {
        break;
      } else {
        q_confirmation_.WaitForResult(MaxWait());
      }
      if (FindConfirmedPath()) {
        break;
      }
      if (settings_.confirmation_threads == 0) {
        RunConfirmationTurn();
      }
      ReportProgress();
    }
    confirmation_.CancelJobs();
    CompleteResult();
  }

 private:
  void InitializeActionGraphs() {
    const ExplorationContext context = {
        .actions = &actions_,
        .space = &space_,
        .master = &master_,
        .generator = &generator_,
        .deadline = &deadline_,
        .counters = &result_.counters,
        .max_transitions_per_cycle = settings_.max_transitions_per_cycle};
    for (std::size_t i = 0; i < actions_.size(); ++i) {
      const auto skip = settings_.skip_growth.find(actions_[i]->name());
      skip_growth_.push_back(skip == settings_.skip_growth.end() ? 0 : skip->second);
      explorations_.push_back(MakeActionExploration(*actions_[i], static_cast<int>(i), context));
      explorations_[i]->AddInitialVertex(master_.start());
      for (const VertexId goal : master_.goals()) {
        explorations_[i]->AddInitialVertex(goal);
      }
    }
  }

  void Explore() {
    for (std::size_t a = 0; a < explorations_.size(); ++a) {
      NewElements found = explorations_[a]->PerformTransitions();
      if (!Skips(a)) {
        const Point p_target = space_.RandomSample(&generator_);
        found.Append(explorations_[a]->GrowTowards(p_target));
      }
      for (std::size_t other = 0; other < explorations_.size(); ++other) {
        if (other != a) {
          explorations_[other]->TakeOver(found);
        }
      }
      master_.Append(static_cast<int>(a), found.edges);
      for (const LineUpEdge& line_up : found.line_ups) {
        master_.Append(line_up.action, {line_up.edge});
      }
    }
  }

  bool SuggestionIsDue() const {
    return settings_.suggestion && num_suggestions_ < kMostSuggestions &&
           (num_suggestions_ == 0 || NumRefuted() > refuted_before_suggestion_);
  }

  std::int64_t NumRefuted() const {
    const auto refuted = result_.counters.find("jobs refuted");
    return refuted == result_.counters.end() ? 0 : refuted->second;
  }

  void ExploreSuggestion() {
    ++num_suggestions_;
    refuted_before_suggestion_ = NumRefuted();
    const std::vector<PathEdge> route = settings_.suggestion();
    nothing_suggested_ = route.empty();
    VertexId v = master_.start();
    for (const PathEdge& step : route) {
      const std::optional<VertexId> existing = master_.FindVertexAt(step.points.to);
      const PointPair points = {master_.point(v),
                                existing ? master_.point(*existing) : step.points.to};
      const Action& action = *actions_[step.action];
      const bool is_sure = action.CS(points);
      if (!is_sure && !(action.Explorable(points.to) && action.Explorable(points))) {
        return;
      }
      const VertexId next = existing ? *existing : master_.VertexAt(points.to);
      if (next == v) {
        continue;
      }
      AppendFound(
          step.action,
          {.vertices = {next}, .edges = {{v, next, action.IsReversible()}}, .offered = {next}});
      if (is_sure) {
        confirmation_.OnSufficientConditions(step.action, v, next);
      }
      v = next;
    }
  }

  /// An edge of `action` that no exploration of its own has found.
  void AppendFound(int action, const NewElements& found) {
    explorations_[action]->action_graph().Append(found);
    for (std::size_t other = 0; other < explorations_.size(); ++other) {
      if (static_cast<int>(other) != action) {
        explorations_[other]->TakeOver(found);
      }
    }
    master_.Append(action, found.edges);
  }

  bool Skips(std::size_t action) {
    return skip_growth_[action] > 0 && UniformReal(0, 1, &generator_) < skip_growth_[action];
  }

  bool FindConfirmedPath() {
    for (std::size_t g = 0; g < master_.goals().size(); ++g) {
      while (master_.Connected(master_.goals()[g]) && !deadline_.Passed()) {
        const auto path = master_.ShortestPath(master_.start(), master_.goals()[g]);
        if (!path) {
          break;
        }
        best_route_seconds_ = Duration(*path);
        if (confirmation_.ConfirmPath(*path)) {
          SetFound(static_cast<int>(g), *path);
          return true;
        }
      }
    }
    return false;
  }

  /// A turn in vain leaves exploration some cycles; the next turn is longer, and so is what it
  /// leaves: both grow to what the jobs take, and shrink as jobs end. Nothing here asks what time
  /// it is: one seed, one search.
  void RunConfirmationTurn() {
    if (cycles_ < next_turn_ && !ExplorationIsOver()) {
      return;
    }
    if (q_confirmation_.RunTurn(deadline_, turn_length_)) {
      turn_length_ = std::max(turn_length_ - 1, 1);
    } else {
      next_turn_ = cycles_ + turn_length_ * kCyclesAfterTurnInVain;
      turn_length_ = std::min(turn_length_ + 1, kLongestTurn);
    }
  }

  double Duration(const std::vector<EdgeId>& path) const {
    double duration = 0;
    for (const EdgeId edge : path) {
      duration += master_.duration(edge);
    }
    return duration;
  }

  void SetFound(int goal, const std::vector<EdgeId>& path) {
    result_.status = PathStatus::kFound;
    result_.goal = goal;
    for (const EdgeId edge : path) {
      result_.path.push_back({master_.confirmed_by(edge), master_.points(edge)});
    }
  }

  bool ExplorationIsOver() const {
    return settings_.max_cycles >= 0 && cycles_ >= settings_.max_cycles;
  }

  /// Whether the oracle, if it is its time, ends the search.
  bool Answered() {
    // While jobs look into a suggested route, a whole search for a "no" would only hold them up.
    const std::int64_t patience = num_suggestions_ > 0 ? 10 : 1;
    const bool is_due = cycles_ >= patience * settings_.ask_oracle_after || nothing_suggested_;
    if (oracle_asked_ || !settings_.oracle || !is_due) {
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
        break;
    }
    return false;
  }

  /// Without threads no result can come while we wait.
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

  const FindPathSettings& settings_;
  const ExplorationSpace& space_;
  const std::vector<std::shared_ptr<const Action>>& actions_;
  const Deadline& deadline_;
  PathResult& result_;
  RandomGenerator generator_;
  PossibilityGraph master_;
  ConfirmationQueue q_confirmation_;
  PathConfirmation confirmation_;
  std::vector<std::unique_ptr<ActionExploration>> explorations_;
  std::vector<double> skip_growth_;  ///< per action
  std::int64_t cycles_ = 0;
  int num_suggestions_ = 0;
  std::int64_t refuted_before_suggestion_ = 0;
  bool nothing_suggested_ = false;
  bool oracle_asked_ = false;
  double next_progress_ = 0;
  std::int64_t next_turn_ = 0;  ///< cycle
  int turn_length_ = 1;
  double best_route_seconds_ = 0;
};

}  // namespace

// What a straight answer runs through is kept together ([[gnu::hot]]), and apart from the search:
// cold code would cost more than the answer (docs/performance.md).
[[gnu::hot]] PathResult FindPath(const Point& start, const std::vector<Point>& goals,
                                 const std::vector<std::shared_ptr<const Action>>& actions,
                                 const ExplorationSpace& space, const FindPathSettings& settings) {
  const Deadline deadline(settings.time_limit);
  CheckFindPathArguments(start, goals, actions, settings);
  PathResult result;
  if (!settings.straight_first || !GoStraight(start, goals, actions, deadline, &result)) {
    PathFinder(start, goals, actions, space, settings, deadline, &result).FindPath();
  }
  return result;
}

}  // namespace possibility::graph
