#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/search/explorer.h"
#include "graph/search/path_confirmation.h"

namespace possibility::graph {

/// The explorers of one search. Gives them their turns.
class Exploration {
 public:
  /// `confirmation` and everything in `context` must outlive this.
  Exploration(const ExplorerContext& context, const std::vector<ExplorerFactory>& explorers,
              PathConfirmation* confirmation);

  /// One cycle: every explorer that takes part has a turn, in order. The cycle ends early after an
  /// explorer that leads on or has nothing left, so that its findings are confirmed first.
  void Explore(SearchStage stage);

  /// Whether no explorer that takes part has anything left to explore.
  bool IsOver(SearchStage stage) const;

  /// Whether some explorer that takes part has nothing left to explore.
  bool SomebodyIsThrough(SearchStage stage) const;

  /// See Explorer.
  void OnRefuted();
  void OnUndecided();
  void OnRoute(const std::vector<PathEdge>& route, double duration);

  /// Appends a route that `found_by` proposes, see Findings::route.
  void AppendRoute(const std::vector<PathEdge>& route, const std::string& found_by);

  /// Name of the explorer that found an edge of Gamma_PG.
  const std::string& found_by(EdgeId edge) const { return names_[found_by_[edge]]; }

  /// Work of all turns so far, s: the sum of their declared work_of_turn. If the turns took more
  /// than ten times as long, the measured time, so that a slow condition that does not declare its
  /// cost keeps no job waiting.
  double work() const;

  /// A lower bound of the expected duration of all routes that explorers with a bound have
  /// explored, s: the least of their bounds. Explorers that know none (0) say nothing of their
  /// routes, so those are not covered. 0 if no explorer knows a bound.
  double lower_bound() const;

 private:
  struct Seat {
    std::unique_ptr<Explorer> explorer;
    Outlook outlook = Outlook::kOpen;
  };

  bool IsWaiting(const Seat& seat, SearchStage stage) const;
  void TakeTurn(Seat* seat);
  /// Appends an edge and asks C_S at once whether it is possible. False if the action does not
  /// accept the edge.
  bool AppendEdge(int action, VertexId from, VertexId to);
  void LabelNewEdges(const std::string& name);

  ExplorerContext context_;
  PathConfirmation* confirmation_;
  std::vector<Seat> seats_;
  std::vector<std::string> names_;
  std::vector<int> found_by_;  ///< per edge of Gamma_PG: index into names_
  double declared_ = 0;        ///< s
  double measured_ = 0;        ///< s
};

}  // namespace possibility::graph
