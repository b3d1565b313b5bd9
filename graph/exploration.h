#pragma once

#include <memory>
#include <string>
#include <vector>

#include "graph/explorer.h"
#include "graph/path_confirmation.h"

namespace possibility::graph {

/// The explorers of one search, and whose turn it is.
class Exploration {
 public:
  /// `confirmation` must outlive this, as everything in `context`.
  Exploration(const ExplorerContext& context, const std::vector<ExplorerFactory>& explorers,
              PathConfirmation* confirmation);

  /// One cycle: every explorer that takes part has a turn, in their order, up to the first that
  /// leads on, or comes to its end: then it is time to think.
  void Explore(SearchStage stage);

  /// Whether no explorer that takes part has anything left to explore.
  bool IsOver(SearchStage stage) const;

  /// Whether some explorer that takes part has nothing left to explore.
  bool SomebodyIsThrough(SearchStage stage) const;

  /// See Explorer.
  void OnRefuted();
  void OnRoute(const std::vector<PathEdge>& route, double duration);

  /// A route that `found_by` proposes, as Findings::route.
  void AppendRoute(const std::vector<PathEdge>& route, const std::string& found_by);

  /// Who found an edge of Gamma_PG.
  const std::string& found_by(EdgeId edge) const { return names_[found_by_[edge]]; }

  /// What all turns took so far as their authors declare it, s. If they took more than ten times
  /// as long, what they took: a condition that is slow and does not say so keeps no job waiting.
  double work() const;

  /// The greatest of all explorers, s.
  double lower_bound() const;

 private:
  struct Seat {
    std::unique_ptr<Explorer> explorer;
    Outlook outlook = Outlook::kOpen;
  };

  bool IsWaiting(const Seat& seat, SearchStage stage) const;
  void TakeTurn(Seat* seat);
  /// The edge's possibility is asked of C_S at once; false if the action does not accept it.
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
