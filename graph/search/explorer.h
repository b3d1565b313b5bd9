#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/deadline.h"
#include "graph/action/action.h"
#include "graph/action/random.h"
#include "graph/structure/path_edge.h"
#include "graph/structure/possibility_graph.h"

namespace possibility::graph {

struct FindPathSettings;

/// Counts of attempts and their outcomes, by name. For reports only: the search does not depend on
/// it.
using Counters = std::map<std::string, std::int64_t>;

/// The search as its explorers see it. Everything pointed to outlives the explorers.
struct ExplorerContext {
  const std::vector<std::shared_ptr<const Action>>* actions = nullptr;
  const ExplorationSpace* space = nullptr;
  const FindPathSettings* settings = nullptr;
  PossibilityGraph* master = nullptr;
  RandomGenerator* generator = nullptr;
  const Deadline* deadline = nullptr;
  Counters* counters = nullptr;
};

enum class Outlook {
  kLeadsOn,  ///< this turn came closer to a route: the next turn belongs to this explorer alone
  kOpen,     ///< there is more to explore
  kOver,     ///< nothing is left to explore, unless edges are refuted or a route is confirmed
};

/// The result of one turn of an explorer.
struct Findings {
  Outlook outlook = Outlook::kOver;
  /// A route worth exploring: edges end to end, from a vertex of Gamma_PG. The part that the
  /// actions accept enters Gamma_PG. May be empty.
  std::vector<PathEdge> route;
};

/// Edges that were found for one action; their vertices are those of Gamma_PG.
struct Discovery {
  int action = 0;
  NewElements elements;
};

/// What a search currently looks for.
enum class SearchStage {
  kFirstRoute,
  kImprovement,  ///< a route is confirmed: look for quicker ones
};

/// Proposes vertices and edges: the inner loop of Algorithm 1. A search may have several explorers
/// that grow one Gamma_PG. Deterministic: the same calls give the same findings.
class Explorer {
 public:
  virtual ~Explorer() = default;

  /// Name in reports: "random", "lattice", ...
  virtual std::string name() const = 0;

  virtual bool TakesPart(SearchStage stage) const = 0;

  /// One turn. Takes a few milliseconds; cut short at the deadline.
  virtual Findings Explore() = 0;

  /// Declared work of the last turn, s. Exploration and confirmation jobs divide their time by it.
  virtual double work_of_turn() const = 0;

  /// Called when an edge that another explorer found enters Gamma_PG.
  virtual void TakeOver(const Discovery&) {}

  /// Called when jobs have refuted edges. Returns whether that leaves something to explore.
  virtual bool OnRefuted() { return false; }

  /// Called when the oracle could not tell whether a route exists.
  virtual void OnUndecided() {}

  /// Called when a route from the start to a goal is confirmed that is quicker than any before;
  /// `duration` in s. Returns whether that leaves something to explore.
  virtual bool OnRoute(const std::vector<PathEdge>& /*route*/, double /*duration*/) {
    return false;
  }

  /// Current lower bound of the expected duration of all routes that it explores, s.
  virtual double lower_bound() const { return 0; }
};

using ExplorerFactory = std::function<std::unique_ptr<Explorer>(const ExplorerContext&)>;

}  // namespace possibility::graph
