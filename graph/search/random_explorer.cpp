#include "graph/search/random_explorer.h"

#include "graph/search/find_path.h"

namespace possibility::graph {

RandomExplorer::RandomExplorer(const ExplorerContext& context) : context_(context) {
  const FindPathSettings& settings = *context.settings;
  for (std::size_t i = 0; i < context.actions->size(); ++i) {
    const Action& action = *(*context.actions)[i];
    const auto skip = settings.skip_growth.find(action.name());
    skip_growth_.push_back(skip == settings.skip_growth.end() ? 0 : skip->second);
    budget_ += action.cycle_budget();
    explorations_.push_back(MakeActionExploration(action, static_cast<int>(i), context));
    explorations_[i]->AddInitialVertex(context.master->start());
    for (const VertexId goal : context.master->goals()) {
      explorations_[i]->AddInitialVertex(goal);
    }
  }
}

Findings RandomExplorer::Explore() {
  if (GraphIsFull()) {
    (*context_.counters)[kGraphIsFull] = 1;
    return {Outlook::kOver, {}};
  }
  if (turns_left_ == 0) {
    (*context_.counters)[kEffortIsSpent] = 1;
    return {Outlook::kOver, {}};
  }
  if (turns_left_ > 0) --turns_left_;
  growth_work_of_turn_ = 0;
  for (std::size_t a = 0; a < explorations_.size(); ++a) {
    const double before = explorations_[a]->growth_work();
    NewElements found = explorations_[a]->PerformTransitions();
    if (!Skips(a)) {
      const Point p_target = context_.space->RandomSample(context_.generator);
      found.Append(explorations_[a]->GrowTowards(p_target));
    }
    growth_work_of_turn_ += explorations_[a]->growth_work() - before;
    OfferToOthers(a, found);
    context_.master->Append(static_cast<int>(a), found.edges);
    for (const LineUpEdge& line_up : found.line_ups) {
      context_.master->Append(line_up.action, {line_up.edge});
    }
  }
  return {Outlook::kOpen, {}};
}

void RandomExplorer::OnUndecided() { turns_left_ = context_.settings->turns_after_oracle; }

void RandomExplorer::TakeOver(const Discovery& discovery) {
  explorations_[discovery.action]->action_graph().Append(discovery.elements);
  OfferToOthers(discovery.action, discovery.elements);
}

void RandomExplorer::OfferToOthers(std::size_t action, const NewElements& found) {
  for (std::size_t other = 0; other < explorations_.size(); ++other) {
    if (other != action) {
      explorations_[other]->TakeOver(found);
    }
  }
}

bool RandomExplorer::GraphIsFull() const {
  const DirectedGraph& topology = context_.master->topology();
  return topology.num_vertices() + std::int64_t{topology.num_edges()} >=
         context_.settings->max_graph_size;
}

bool RandomExplorer::Skips(std::size_t action) {
  const double skip = skip_growth_[action];
  if (skip <= 0 || skip >= 1) return skip > 0;  // leaves the generator alone
  return UniformReal(0, 1, context_.generator) < skip;
}

ExplorerFactory RandomExploration() {
  return [](const ExplorerContext& context) { return std::make_unique<RandomExplorer>(context); };
}

}  // namespace possibility::graph
