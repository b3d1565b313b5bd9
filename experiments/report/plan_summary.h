#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "actions/planner/planner.h"

namespace possibility::experiments {

/// Consecutive segments of the same action.
struct ActionSpan {
  std::string action;
  double begin = 0;     ///< s
  double duration = 0;  ///< s
};
std::vector<ActionSpan> RouteByAction(const actions::Plan& plan);

/// Planning time, s: preparation, graph (including confirmation) and motion.
double PlanningSeconds(const actions::Plan& plan);

/// The paper's real-time ratio (its table of results): execution time of the plan over planning
/// time. None if no time was measured.
std::optional<double> RealTimeRatio(const actions::Plan& plan);

/// Files written for a plan that was found.
struct PlanFiles {
  std::filesystem::path plan;
  std::filesystem::path page;
};

/// A readable table: status, route, times, files. `robot`: the plan's.
std::string SummaryText(const actions::PlanResult& result, const models::RobotModel& robot,
                        const PlanFiles& files);

/// One JSON object (docs/command_line.md). `files` is used only if a plan was found.
std::string SummaryJson(const actions::PlanResult& result, const models::RobotModel& robot,
                        const PlanFiles& files);

}  // namespace possibility::experiments
