#include "actions/planner/plan_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "graph/search/random_explorer.h"

namespace possibility::actions {
namespace {

constexpr double kAtTheGoal = 1e-6;  // m

/// "1 cycle", "2 cycles".
std::string Counted(std::int64_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// The first few refusals with their reasons, after a heading.
std::string Listed(const std::vector<Refusal>& refusals, const std::string& heading) {
  constexpr size_t kAtMost = 3;
  if (refusals.empty()) return {};
  std::string text = fmt::format(" {}:", heading);
  for (size_t i = 0; i < std::min(refusals.size(), kAtMost); ++i) {
    const graph::Point& from = refusals[i].edge.from;
    text += fmt::format("{} from ({:.2f}, {:.2f}): {}", i == 0 ? "" : ";", from.x(), from.y(),
                        refusals[i].reason);
  }
  return text + (refusals.size() > kAtMost ? "; ..." : ".");
}

std::int64_t Count(const std::map<std::string, std::int64_t>& statistics, const std::string& name) {
  const auto found = statistics.find(name);
  return found == statistics.end() ? 0 : found->second;
}

/// A counter that the search keeps for every action (graph/), and its wording.
struct RefusalWords {
  const char* counter;  ///< after "<action>: "
  const char* one;      ///< format string of an action, after the count 1
  const char* many;     ///< after other counts
};

constexpr RefusalWords kRefusalWords[] = {
    {"extend rejected at vertex", "place where '{}' cannot be", "places where '{}' cannot be"},
    {"extend rejected on edge", "way that '{}' cannot go", "ways that '{}' cannot go"},
    {"extend stopped at removed edge", "way of '{}' that was refuted before",
     "ways of '{}' that were refuted before"},
    {"growth rejected", "try of '{}' that its conditions refuse",
     "tries of '{}' that its conditions refuse"},
    {"growth stopped at removed edge", "try of '{}' that was refuted before",
     "tries of '{}' that were refuted before"},
    {"growth not lined up", "try of '{}' to which no way leads",
     "tries of '{}' to which no way leads"},
    {"transition failed", "change to '{}' that led nowhere", "changes to '{}' that led nowhere"},
};

/// The three most frequent, in descending order.
std::vector<std::string> MostFrequentRefusals(
    const std::map<std::string, std::int64_t>& statistics) {
  constexpr std::size_t kAtMost = 3;
  std::vector<std::pair<std::int64_t, std::string>> refusals;
  for (const auto& [name, count] : statistics) {
    const std::size_t colon = name.find(": ");
    if (count == 0 || colon == std::string::npos) continue;
    for (const RefusalWords& refusal : kRefusalWords) {
      if (name.substr(colon + 2) != refusal.counter) continue;
      const char* words = count == 1 ? refusal.one : refusal.many;
      refusals.emplace_back(
          count,
          fmt::format("{} {}", count, fmt::format(fmt::runtime(words), name.substr(0, colon))));
    }
  }
  std::stable_sort(refusals.begin(), refusals.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> first;
  for (std::size_t i = 0; i < std::min(refusals.size(), kAtMost); ++i) {
    first.push_back(refusals[i].second);
  }
  return first;
}

/// By vertex: whether it is reachable from the first one.
std::vector<bool> ReachedFromStart(const ExploredGraph& explored) {
  std::vector<std::vector<int>> next(explored.vertices.size());
  for (const ExploredGraph::Edge& edge : explored.edges) next[edge.from].push_back(edge.to);
  std::vector<bool> reached(explored.vertices.size(), false);
  if (reached.empty()) return reached;
  std::vector<int> open = {0};
  reached[0] = true;
  while (!open.empty()) {
    const int v = open.back();
    open.pop_back();
    for (const int to : next[v]) {
      if (reached[to]) continue;
      reached[to] = true;
      open.push_back(to);
    }
  }
  return reached;
}

}  // namespace

std::string ExplainBarrier(PlanStatus status, const Barrier& barrier) {
  return fmt::format(
      "{}: the search came within {:.2f} m of a goal, at ({:.2f}, {:.2f}); the way on is closed "
      "by {}.",
      status == PlanStatus::kProvenInfeasible
          ? "no route exists within the scenario's bounds, not even for the pelvis alone"
          : "no route exists that these actions could confirm",
      barrier.distance, barrier.closest.x(), barrier.closest.y(),
      barrier.closed_by.empty() ? "the bounds"
                                : fmt::format("{}", fmt::join(barrier.closed_by, ", ")));
}

std::string ExplainEffort(int turns) {
  return fmt::format(
      "no route was found: contact planning has led nowhere, and {} of random exploration have "
      "found none.",
      Counted(turns, "turn"));
}

std::string ExplainSearch(const std::map<std::string, std::int64_t>& statistics) {
  const std::int64_t cycles = Count(statistics, "cycles");
  if (cycles == 0) return {};
  std::string text = fmt::format(
      " The search went through {} and knows {} and {} between them.", Counted(cycles, "cycle"),
      Counted(Count(statistics, "vertices"), "place"), Counted(Count(statistics, "edges"), "way"));
  if (Count(statistics, graph::kGraphIsFull) > 0) {
    text += " It ended because the graph is full.";
  }
  const std::vector<std::string> refusals = MostFrequentRefusals(statistics);
  if (!refusals.empty()) text += fmt::format(" Most often: {}.", fmt::join(refusals, "; "));
  if (const std::int64_t jobs = Count(statistics, "jobs spawned"); jobs > 0) {
    text += fmt::format(" Of {}, {} confirmed, {} refuted, {} failed and {} not needed any more.",
                        Counted(jobs, "confirmation job"), Count(statistics, "jobs confirmed"),
                        Count(statistics, "jobs refuted"), Count(statistics, "jobs failed"),
                        Count(statistics, "jobs cancelled"));
  }
  return text;
}

std::string ExplainClosest(const ExploredGraph& explored,
                           const std::vector<models::Stance>& goals) {
  const std::vector<bool> reached = ReachedFromStart(explored);
  if (std::count(reached.begin(), reached.end(), true) < 2 || goals.empty()) return {};
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector2d closest = Eigen::Vector2d::Zero();
  for (std::size_t v = 0; v < reached.size(); ++v) {
    if (!reached[v]) continue;
    const Eigen::Vector2d place = explored.vertices[v].position.head<2>();
    for (const models::Stance& goal : goals) {
      const double distance = (Eigen::Vector2d(goal.x, goal.y) - place).norm();
      if (distance >= least) continue;
      least = distance;
      closest = place;
    }
  }
  if (least < kAtTheGoal) {
    return " Ways were explored as far as a goal, but none of them could be confirmed in time.";
  }
  return fmt::format(" It came within {:.2f} m of a goal, at ({:.2f}, {:.2f}).", least, closest.x(),
                     closest.y());
}

std::string ExplainManoeuvres(const std::vector<std::shared_ptr<SearchedManoeuvre>>& manoeuvres,
                              const FailedJobs& failures) {
  std::string text;
  for (const auto& manoeuvre : manoeuvres) {
    const std::vector<Refusal> refuted = manoeuvre->Refusals();
    text += Listed(refuted, fmt::format("{} of '{}' refuted", refuted.size(), manoeuvre->name()));
    const auto failed = failures.find(manoeuvre->name());
    if (failed == failures.end()) continue;
    text += Listed(failed->second,
                   fmt::format("{} of '{}' failed",
                               Counted(static_cast<std::int64_t>(failed->second.size()), "job"),
                               manoeuvre->name()));
  }
  return text;
}

}  // namespace possibility::actions
