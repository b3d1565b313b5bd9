#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/searched_manoeuvre.h"
#include "actions/plan/plan.h"
#include "actions/planner/planner.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Edges whose jobs failed, by the name of their action.
using FailedJobs = std::map<std::string, std::vector<Refusal>>;

/// One sentence: how close the search came and what blocks the way beyond. `status`: one of the
/// "no"s.
std::string ExplainBarrier(PlanStatus status, const Barrier& barrier);

/// One sentence, where the floods found no barrier: the effort after which the search ended.
/// `turns`: of random exploration.
std::string ExplainEffort(int turns);

/// Reports what was explored, the most frequent refusals and the outcome of confirmation jobs.
/// Begins with a space; empty if the search ran no cycle.
std::string ExplainSearch(const std::map<std::string, std::int64_t>& statistics);

/// Reports the least horizontal distance to a goal of the vertices reached from the start, the
/// graph's first vertex. Begins with a space; empty if no other vertex was reached.
std::string ExplainClosest(const ExploredGraph& explored, const std::vector<models::Stance>& goals);

/// Lists refused and failed manoeuvres, the first few of each, with the reasons. Begins with a
/// space unless empty.
std::string ExplainManoeuvres(const std::vector<std::shared_ptr<SearchedManoeuvre>>& manoeuvres,
                              const FailedJobs& failures);

}  // namespace possibility::actions
