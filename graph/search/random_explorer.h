#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/search/action_exploration.h"
#include "graph/search/explorer.h"

namespace possibility::graph {

/// Counter that is 1 once FindPathSettings::max_graph_size has ended random exploration.
inline constexpr const char* kGraphIsFull = "random exploration: graph is full";

/// Counter that is 1 once FindPathSettings::turns_after_oracle has ended random exploration.
inline constexpr const char* kEffortIsSpent = "random exploration: effort is spent";

/// The paper's exploration: every action performs transitions (Algorithm 2) and grows towards
/// random targets (Algorithms 3 and 4). A turn is one round of Algorithm 1.
class RandomExplorer : public Explorer {
 public:
  /// @throws std::invalid_argument if an action is of a kind that cannot be grown.
  explicit RandomExplorer(const ExplorerContext& context);

  std::string name() const override { return "random"; }
  bool TakesPart(SearchStage stage) const override { return stage == SearchStage::kFirstRoute; }
  Findings Explore() override;
  double work_of_turn() const override { return budget_ + growth_work_of_turn_; }
  void TakeOver(const Discovery& discovery) override;
  void OnUndecided() override;

 private:
  bool GraphIsFull() const;
  bool Skips(std::size_t action);
  void OfferToOthers(std::size_t action, const NewElements& found);

  ExplorerContext context_;
  std::vector<std::unique_ptr<ActionExploration>> explorations_;
  std::vector<double> skip_growth_;  ///< per action
  std::int64_t turns_left_ = -1;     ///< -1: no limit
  double budget_ = 0;                ///< of the conditions in one turn, s
  double growth_work_of_turn_ = 0;   ///< beyond it, in the last turn, s
};

ExplorerFactory RandomExploration();

}  // namespace possibility::graph
