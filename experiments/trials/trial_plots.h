#pragma once

#include <string>
#include <vector>

#include "experiments/report/svg_plot.h"
#include "experiments/trials/trial_groups.h"

namespace possibility::experiments {

/// Share of the trials with a plan whose metric is at most x, per group; logarithmic. Rows have
/// colours, presets strokes (default full, others dashed).
Plot DistributionPlot(const std::vector<TrialGroup>& groups, const TrialMetric& metric);

/// Share of all trials that have a verified plan after so many seconds of preparation, graph,
/// motion and verification.
Plot SuccessPlot(const std::vector<TrialGroup>& groups);

/// Where the time goes: an SVG document with a bar per group, divided like the mean time of its
/// trials with a plan (graph without confirmation).
std::string TimeSharesPicture(const std::vector<TrialGroup>& groups);

}  // namespace possibility::experiments
