#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "actions/planner/planner.h"

namespace possibility::experiments {

/// Segments of the same action in a row, as one.
struct RouteLeg {
  std::string action;
  double begin = 0;     ///< s
  double duration = 0;  ///< s
};
std::vector<RouteLeg> RouteByAction(const actions::Plan& plan);

/// What planning took, s: preparation, graph (confirmation is part of it) and motion.
double PlanningSeconds(const actions::Plan& plan);

/// The paper's real-time ratio (its table of results): how long the plan takes to execute over how
/// long it took to plan. None if no time was measured.
std::optional<double> RealTimeRatio(const actions::Plan& plan);

/// Where the files of a plan that was found went.
struct PlanFiles {
  std::filesystem::path plan;
  std::filesystem::path page;
};

/// A table for people: status, route, times, files.
std::string SummaryText(const actions::PlanResult& result, const PlanFiles& files);

/// One JSON object (docs/command_line.md). `files` counts only if a plan was found.
std::string SummaryJson(const actions::PlanResult& result, const PlanFiles& files);

}  // namespace possibility::experiments
