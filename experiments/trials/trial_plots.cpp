#include "experiments/trials/trial_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/support/xml_text.h"

namespace possibility::experiments {
namespace {

/// Short label for the legend.
std::string LabelOf(const TrialGroup& group) {
  return group.preset == "default" ? group.row : group.row + " " + group.preset;
}

/// Steps from 0 up to values.size() / `of`, at ascending values.
PlotCurve Steps(std::vector<double> values, std::size_t of) {
  std::sort(values.begin(), values.end());
  PlotCurve curve;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const std::size_t count : {i, i + 1}) {
      curve.x.push_back(values[i]);
      curve.y.push_back(static_cast<double>(count) / static_cast<double>(of));
    }
  }
  return curve;
}

/// One colour per row, in the order in which rows appear.
int ColorOf(const std::vector<TrialGroup>& groups, const std::string& row) {
  std::vector<std::string> rows;
  for (const TrialGroup& group : groups) {
    if (std::find(rows.begin(), rows.end(), group.row) == rows.end()) rows.push_back(group.row);
  }
  return static_cast<int>(std::find(rows.begin(), rows.end(), row) - rows.begin());
}

void Add(const std::vector<TrialGroup>& groups, const TrialGroup& group, PlotCurve curve,
         Plot* plot) {
  curve.label = LabelOf(group);
  curve.style = group.preset == "default" ? CurveStyle::kLine : CurveStyle::kDashed;
  curve.color = ColorOf(groups, group.row);
  plot->curves.push_back(std::move(curve));
}

/// Sets the axis to the decades of all curves: otherwise a small range may contain no tick.
void ShowDecades(Plot* plot) {
  double low = HUGE_VAL, high = 0;
  for (const PlotCurve& curve : plot->curves) {
    for (const double x : curve.x) {
      if (x <= 0) continue;
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  if (high <= 0) return;
  const double first = std::floor(std::log10(low));
  const double last = std::max(first + 1, std::ceil(std::log10(high)));
  plot->x.range = {std::pow(10, first), std::pow(10, last)};
}

double TotalSeconds(const TrialRecord& record) {
  const actions::PlanTimings& t = record.timings;
  return t.preparation_s + t.graph_s + t.motion_s + t.verification_s;
}

Plot EmptyPlot(const std::string& title, const PlotAxis& x, const std::string& y) {
  Plot plot;
  plot.title = title;
  plot.x = x;
  plot.x.logarithmic = true;
  plot.y = {y, "", false, std::pair{0.0, 1.02}};
  plot.height = 320;
  return plot;
}

constexpr std::array<std::pair<const char*, const char*>, 5> kParts = {
    {{"preparation", "#adb5bd"},
     {"graph", "#0b6fb8"},
     {"confirmation", "#d9480f"},
     {"motion", "#2b8a3e"},
     {"verification", "#9c36b5"}}};

/// Mean times of kParts, s.
std::array<double, kParts.size()> MeanParts(const TrialGroup& group) {
  const auto mean = [&](const char* name) { return Mean(group.Values(MetricNamed(name))); };
  const double confirmation = mean("confirmation_s");
  // Jobs on other threads may take longer in total than the search that waits for them.
  const double graph = std::max(0.0, mean("graph_s") - confirmation);
  return {mean("preparation_s"), graph, confirmation, mean("motion_s"), mean("verification_s")};
}

constexpr double kLabelWidth = 220, kBarWidth = 480, kLineHeight = 22, kTop = 58;

std::string Bar(const TrialGroup& group, double y) {
  std::string svg = fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
                                kLabelWidth - 8, y + 12, XmlText(LabelOf(group)));
  if (group.successes() == 0) return svg;
  const auto parts = MeanParts(group);
  double total = 0;
  for (const double part : parts) total += part;
  double x = kLabelWidth;
  for (std::size_t i = 0; i < parts.size() && total > 0; ++i) {
    const double width = kBarWidth * parts[i] / total;
    svg += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"16\" fill=\"{}\"/>\n", x, y,
        width, kParts[i].second);
    x += width;
  }
  return svg + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:.3g} s</text>\n",
                           kLabelWidth + kBarWidth + 8, y + 12, total);
}

}  // namespace

Plot DistributionPlot(const std::vector<TrialGroup>& groups, const TrialMetric& metric) {
  Plot plot = EmptyPlot(metric.title + ": distribution", {metric.title, metric.unit, true, {}},
                        "share of plans");
  for (const TrialGroup& group : groups) {
    const std::vector<double> values = group.Values(metric);
    Add(groups, group, Steps(values, values.size()), &plot);
  }
  ShowDecades(&plot);
  return plot;
}

Plot SuccessPlot(const std::vector<TrialGroup>& groups) {
  Plot plot =
      EmptyPlot("Success against time", {"Time until verified", "s", true, {}}, "share of trials");
  for (const TrialGroup& group : groups) {
    std::vector<double> seconds;
    for (const TrialRecord& record : group.trials) {
      if (record.verified) seconds.push_back(TotalSeconds(record));
    }
    Add(groups, group, Steps(seconds, group.trials.size()), &plot);
  }
  ShowDecades(&plot);
  return plot;
}

std::string TimeSharesPicture(const std::vector<TrialGroup>& groups) {
  std::string content =
      "<text x=\"14\" y=\"20\" font-weight=\"600\">Where the time goes (shares of the mean)</text>";
  double x = kLabelWidth;
  for (const auto& [name, color] : kParts) {
    content += fmt::format(
        "<rect x=\"{0:.1f}\" y=\"34\" width=\"12\" height=\"12\" fill=\"{1}\"/>"
        "<text x=\"{2:.1f}\" y=\"44\">{3}</text>\n",
        x, color, x + 16, name);
    x += 100;
  }
  double y = kTop;
  for (const TrialGroup& group : groups) {
    content += Bar(group, y);
    y += kLineHeight;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>text{{font:12px system-ui,\"DejaVu Sans\",Arial,"
      "sans-serif;fill:#343a40}}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
      "{2}</svg>\n",
      kLabelWidth + kBarWidth + 90, y + 10, content);
}

}  // namespace possibility::experiments
