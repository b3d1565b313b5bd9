#include "experiments/trials/sweep_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/report/experiment_page.h"
#include "experiments/report/svg_plot.h"
#include "experiments/report/text_table.h"
#include "experiments/support/output_file.h"
#include "experiments/trials/plan_gallery.h"
#include "experiments/trials/trial_groups.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

double ValueOf(const TrialGroup& group) { return group.trials.front().value; }

std::pair<double, double> SuccessInterval(const TrialGroup& group) {
  return WilsonInterval(group.successes(), static_cast<std::int64_t>(group.trials.size()));
}

double SuccessOf(const TrialGroup& group) {
  return group.successes() / static_cast<double>(group.trials.size());
}

/// The curve of one preset, and the band of its 95 % confidence intervals.
struct Series {
  std::vector<double> x, y, low, high;

  void Add(double at, double value, const std::pair<double, double>& interval) {
    x.push_back(at);
    y.push_back(value);
    low.push_back(interval.first);
    high.push_back(interval.second);
  }
  void Draw(const std::string& label, bool is_default, int color, Plot* plot) const {
    PlotCurve curve{label, x, y, is_default ? CurveStyle::kLine : CurveStyle::kDashed, color, x, y};
    plot->curves.push_back(std::move(curve));
    plot->regions.push_back(Band("", x, low, high, color));
  }
};

std::vector<std::string> PresetsOf(const std::vector<TrialGroup>& groups) {
  std::vector<std::string> presets;
  for (const TrialGroup& group : groups) {
    if (std::find(presets.begin(), presets.end(), group.preset) == presets.end()) {
      presets.push_back(group.preset);
    }
  }
  return presets;
}

constexpr double kWide = 30;  // ratio of times above which the axis is logarithmic

/// Axis over all values, including those without a plan.
PlotAxis ParameterAxis(const std::vector<TrialGroup>& groups) {
  double low = ValueOf(groups.front()), high = low;
  for (const TrialGroup& group : groups) {
    low = std::min(low, ValueOf(group));
    high = std::max(high, ValueOf(group));
  }
  PlotAxis axis{groups.front().trials.front().parameter, "", low > 0 && high / low > kWide, {}};
  if (low < high) axis.range = {low, high};
  return axis;
}

/// Axis from zero, or logarithmic if times differ much.
PlotAxis TimeAxis(const TrialMetric& metric, const std::vector<PlotRegion>& bands) {
  double low = HUGE_VAL, high = 0;
  for (const PlotRegion& band : bands) {
    for (const double y : band.y) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  PlotAxis axis{metric.title, metric.unit, low > 0 && high / low > kWide, {}};
  if (high > 0 && !axis.logarithmic) axis.range = {0, 1.06 * high};
  return axis;
}

Plot SuccessPlotOf(const std::vector<TrialGroup>& groups) {
  Plot plot;
  plot.title = "Success, with Wilson's 95 % confidence intervals";
  plot.x = ParameterAxis(groups);
  plot.y = {"share of trials", "", false, std::pair{0.0, 1.02}};
  plot.height = 300;
  int color = 0;
  for (const std::string& preset : PresetsOf(groups)) {
    Series series;
    for (const TrialGroup& group : groups) {
      if (group.preset != preset) continue;
      series.Add(ValueOf(group), SuccessOf(group), SuccessInterval(group));
    }
    series.Draw(preset, preset == "default", color++, &plot);
  }
  return plot;
}

Plot TimePlot(const std::vector<TrialGroup>& groups, const TrialMetric& metric) {
  Plot plot;
  plot.title = metric.title + ": median, with bootstrap 95 % confidence intervals";
  plot.x = ParameterAxis(groups);
  plot.height = 260;
  int color = 0;
  for (const std::string& preset : PresetsOf(groups)) {
    Series series;
    for (const TrialGroup& group : groups) {
      const std::vector<double> values = group.Values(metric);
      if (group.preset != preset || values.empty()) continue;
      series.Add(ValueOf(group), Median(values), BootstrapMedianInterval(values));
    }
    series.Draw(preset, preset == "default", color++, &plot);
  }
  plot.y = TimeAxis(metric, plot.regions);
  return plot;
}

std::vector<Plot> TimePlots(const std::vector<TrialGroup>& groups) {
  std::vector<Plot> plots;
  for (const char* name : {"graph_s", "motion_s", "preparation_s", "verification_s", "memory_mb"}) {
    plots.push_back(TimePlot(groups, MetricNamed(name)));
  }
  return plots;
}

TextTable Table(const std::vector<TrialGroup>& groups) {
  TextTable table;
  table.header = {groups.front().trials.front().parameter,
                  "Preset",
                  "Trials",
                  "Success (95 %)",
                  "No",
                  "Graph: median (95 %) (s)",
                  "Motion: median (s)",
                  "Verification: median (s)",
                  "Duration: median (s)"};
  const char* none = "\u2013";
  for (const TrialGroup& group : groups) {
    const auto [low, high] = SuccessInterval(group);
    const auto median = [&](const char* name) {
      const std::vector<double> values = group.Values(MetricNamed(name));
      return values.empty() ? std::string(none) : fmt::format("{:.4g}", Median(values));
    };
    std::string graph = median("graph_s");
    if (graph != none) {
      const auto interval = BootstrapMedianInterval(group.Values(MetricNamed("graph_s")));
      graph += fmt::format(" ({:.4g} to {:.4g})", interval.first, interval.second);
    }
    const std::string answers = group.AnswersText();
    table.rows.push_back({fmt::format("{:g}", ValueOf(group)), group.preset,
                          fmt::format("{}", group.trials.size()),
                          fmt::format("{:.3g} ({:.3g} to {:.3g})", SuccessOf(group), low, high),
                          answers.empty() ? none : answers, graph, median("motion_s"),
                          median("verification_s"), median("plan_duration_s")});
  }
  return table;
}

std::string TitleOf(const std::vector<TrialRecord>& trials) {
  return trials.front().identity.experiment;
}

std::string NoteOf(const std::vector<TrialRecord>& trials) {
  return fmt::format(
      "Measured on: {}. One thread per trial. Times are of the trials that found a plan; intervals "
      "are of 95 % confidence: Wilson's score for success, bootstrap for medians.",
      MachinesOf(trials));
}

}  // namespace

Json SweepReport::Summary() const {
  Json json;
  json["format"] = "possibility-sweep/1";
  json["experiment"] = TitleOf(trials);
  json["parameter"] = trials.front().parameter;
  json["machine"] = MachinesOf(trials);
  json["rows"] = Json::array();
  for (const TrialGroup& group : GroupTrials(trials)) {
    Json entry = group.Json();
    entry["value"] = ValueOf(group);
    const auto [low, high] = SuccessInterval(group);
    entry["success_interval"] = {low, high};
    for (const TrialMetric& metric : TrialMetrics()) {
      const std::vector<double> values = group.Values(metric);
      if (values.empty()) continue;
      const auto interval = BootstrapMedianInterval(values);
      entry[metric.name]["median_interval"] = {interval.first, interval.second};
    }
    json["rows"].push_back(std::move(entry));
  }
  return json;
}

std::string SweepReport::Csv() const {
  std::vector<std::string> header = {trials.front().parameter,
                                     "preset",
                                     "trials",
                                     "successes",
                                     "success",
                                     "success_low",
                                     "success_high"};
  for (const TrialMetric& metric : TrialMetrics()) {
    for (const char* part : {"mean", "std", "median", "median_low", "median_high", "p95", "max"}) {
      header.push_back(metric.name + '_' + part);
    }
  }
  std::string csv = fmt::format("{}\n", fmt::join(header, ","));
  for (const TrialGroup& group : GroupTrials(trials)) {
    const auto [low, high] = SuccessInterval(group);
    csv += fmt::format("{},{},{},{},{},{},{}", ValueOf(group), group.preset, group.trials.size(),
                       group.successes(), SuccessOf(group), low, high);
    for (const TrialMetric& metric : TrialMetrics()) {
      const auto s = group.Summary(metric);
      if (!s) {
        csv += ",,,,,,,";
        continue;
      }
      const auto [median_low, median_high] = BootstrapMedianInterval(group.Values(metric));
      csv += fmt::format(",{},{},{},{},{},{},{}", s->mean, s->std, s->median, median_low,
                         median_high, s->p95, s->max);
    }
    csv += '\n';
  }
  return csv;
}

std::string SweepReport::Markdown() const {
  return "# " + TitleOf(trials) + "\n\n" + NoteOf(trials) + "\n\n" +
         Table(GroupTrials(trials)).Markdown();
}

void SweepReport::Write(const std::filesystem::path& folder) const {
  const std::vector<TrialGroup> groups = GroupTrials(trials);
  WriteOutput(folder / "summary.json", models::JsonText(Summary(), 2) + "\n");
  WriteOutput(folder / "sweep.csv", Csv());
  WriteOutput(folder / "sweep.md", Markdown());
  const std::string success = SvgDocument({SuccessPlotOf(groups)});
  const std::string times = SvgDocument(TimePlots(groups));
  WriteOutput(folder / "success.svg", success);
  WriteOutput(folder / "times.svg", times);
  const PageSection curves{"Success and times",
                           {NoteOf(trials)},
                           Table(groups).Html(),
                           {{"Success", success}, {"Times", times}},
                           false};
  WriteOutput(folder / "report.html",
              ExperimentPage(TitleOf(trials), {curves, PlanGallery(groups, folder)}));
}

}  // namespace possibility::experiments
