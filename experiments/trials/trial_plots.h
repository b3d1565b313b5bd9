#pragma once

#include <string>
#include <vector>

#include "experiments/report/svg_plot.h"
#include "experiments/trials/trial_groups.h"

namespace possibility::experiments {

/// Fraction of the trials with a plan whose metric is at most x, per group; logarithmic. Colours
/// distinguish rows, line styles presets (default solid, others dashed).
Plot DistributionPlot(const std::vector<TrialGroup>& groups, const TrialMetric& metric);

/// Fraction of all trials with a verified plan over the total time of preparation, graph, motion
/// and verification.
Plot SuccessPlot(const std::vector<TrialGroup>& groups);

/// Breakdown of times: an SVG document with a bar per group, divided as the mean times of its
/// trials with a plan (graph without confirmation).
std::string TimeSharesPicture(const std::vector<TrialGroup>& groups);

}  // namespace possibility::experiments
