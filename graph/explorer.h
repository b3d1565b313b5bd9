#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "graph/action.h"
#include "graph/deadline.h"
#include "graph/path_edge.h"
#include "graph/possibility_graph.h"
#include "graph/random.h"

namespace possibility::graph {

struct FindPathSettings;

/// What was tried and what came of it, by name. For people: nothing in the search depends on it.
using Counters = std::map<std::string, std::int64_t>;

/// What an explorer knows of the search that it serves; all of it outlives the explorer.
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
  kLeadsOn,  ///< this turn came closer to a route: the next one is this explorer's alone
  kOpen,     ///< there is more to explore
  kOver,     ///< nothing is left, unless edges are refuted or a route is confirmed
};

/// What one turn of an explorer came to.
struct Findings {
  Outlook outlook = Outlook::kOver;
  /// A route worth exploring: edges end to end from a vertex of Gamma_PG. What of it the actions
  /// accept enters Gamma_PG. May be empty.
  std::vector<PathEdge> route;
};

/// Edges of one action that were found; their vertices are those of Gamma_PG.
struct Discovery {
  int action = 0;
  NewElements elements;
};

/// What a search is after.
enum class SearchStage {
  kFirstRoute,
  kImprovement,  ///< a route is confirmed; quicker ones are welcome
};

/// Proposes vertices and edges: the inner loop of Algorithm 1. A search may have several, which
/// grow one Gamma_PG. Deterministic: the same calls, the same findings.
class Explorer {
 public:
  virtual ~Explorer() = default;

  /// By which reports name it: "random", "lattice", ...
  virtual std::string name() const = 0;

  virtual bool TakesPart(SearchStage stage) const = 0;

  /// One turn. Takes some milliseconds; at the deadline it is cut short.
  virtual Findings Explore() = 0;

  /// What a turn takes according to those who wrote it, s: its share in the time that exploration
  /// and confirmation jobs divide between them.
  virtual double work_of_turn() const = 0;

  /// Something that another explorer found has entered Gamma_PG.
  virtual void TakeOver(const Discovery&) {}

  /// Jobs have refuted edges. Whether that leaves something to explore.
  virtual bool OnRefuted() { return false; }

  /// A quicker route than any before is confirmed, from the start to a goal; `duration`: of it, s.
  /// Whether that leaves something to explore.
  virtual bool OnRoute(const std::vector<PathEdge>& /*route*/, double /*duration*/) {
    return false;
  }

  /// No route among all those that it explores is expected to take less, as far as it knows now, s.
  virtual double lower_bound() const { return 0; }
};

using ExplorerFactory = std::function<std::unique_ptr<Explorer>(const ExplorerContext&)>;

}  // namespace possibility::graph
