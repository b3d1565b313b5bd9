#include "experiments/report/jump_reach_plot.h"

#include "experiments/report/svg_plot.h"

namespace possibility::experiments {
namespace {

/// A point per jump, `value` over distance, separately for jumps found and not found.
Plot Scatter(const std::vector<actions::JumpSweepEntry>& entries,
             double (*value)(const actions::JumpSweepEntry&)) {
  Plot plot;
  plot.x.label = "distance";
  plot.x.unit = "m";
  plot.curves.resize(2);
  plot.curves[0].label = "found";
  plot.curves[1].label = "not found";
  for (PlotCurve& curve : plot.curves) curve.style = CurveStyle::kScatter;
  for (const actions::JumpSweepEntry& entry : entries) {
    PlotCurve& curve = plot.curves[entry.is_possible ? 0 : 1];
    curve.x.push_back(entry.task.distance);
    curve.y.push_back(value(entry));
  }
  return plot;
}

}  // namespace

std::string JumpReachPicture(const std::vector<actions::JumpSweepEntry>& entries) {
  Plot reach = Scatter(entries, [](const auto& entry) { return entry.task.height; });
  reach.title = "Jumps";
  reach.y.label = "height";
  reach.y.unit = "m";
  reach.height = 320;
  Plot cost = Scatter(entries, [](const auto& entry) { return entry.effort.total; });
  cost.title = "Time to an answer";
  cost.y.label = "time";
  cost.y.unit = "s";
  cost.y.logarithmic = true;
  return SvgDocument({reach, cost});
}

}  // namespace possibility::experiments
