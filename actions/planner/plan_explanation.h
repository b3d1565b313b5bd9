#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/plan/plan.h"
#include "actions/planner/planner.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Edges whose jobs failed, by the name of their action.
using FailedJobs = std::map<std::string, std::vector<Manoeuvre::Refusal>>;

/// One sentence: how near the search came, and what closes the way on. `status`: one of the "no"s.
std::string ExplainBarrier(PlanStatus status, const Barrier& barrier);

/// What was explored, what refused most of what was tried, and what became of confirmation jobs.
/// Begins with a space; nothing if the search went through no cycle.
std::string ExplainSearch(const std::map<std::string, std::int64_t>& statistics);

/// How near to a goal (seen from above) the ways lead that were explored from the first vertex of
/// the graph, the start. Begins with a space; nothing if they lead nowhere.
std::string ExplainClosest(const ExploredGraph& explored, const std::vector<models::Stance>& goals);

/// What came of manoeuvres that are no part of the answer: of each the first few, and why. Begins
/// with a space unless empty.
std::string ExplainManoeuvres(const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                              const FailedJobs& failures);

}  // namespace possibility::actions
