#include "experiments/trials/table_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "experiments/report/experiment_page.h"
#include "experiments/report/text_table.h"
#include "experiments/support/output_file.h"
#include "experiments/support/run_environment.h"
#include "experiments/trials/plan_gallery.h"
#include "experiments/trials/table_rows.h"
#include "experiments/trials/trial_groups.h"
#include "experiments/trials/trial_plots.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPaperMachine = "Intel Xeon E3-1290 v2, 3.70 GHz (the paper's)";
constexpr const char* kNone = "\u2013";

const TableRow* Find(const std::string& name) {
  const auto& rows = TableRows();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const TableRow& r) { return r.name == name; });
  return row == rows.end() ? nullptr : &*row;
}

/// Formats times of any size with enough digits to compare them.
std::string Number(double value) {
  const double size = std::abs(value);
  if (size > 0 && size < 0.01) return fmt::format("{:.5f}", value);
  return fmt::format("{:.{}f}", value, size < 10 ? 3 : size < 100 ? 2 : 1);
}

std::string MeanAndStd(const std::optional<SampleSummary>& summary) {
  return summary ? fmt::format("{} ({})", Number(summary->mean), Number(summary->std)) : kNone;
}

std::string Printed(const PrintedFigure& figure) {
  return fmt::format("{:g} ({:g})", figure.mean, figure.std);
}

std::string Percent(double share) { return fmt::format("{:.4g} %", 100 * share); }

/// Explorers of the routes' edges, over all trials.
std::string ExplorersOf(const TrialGroup& group) {
  std::set<std::string> all;
  for (const TrialRecord& trial : group.trials) {
    if (!trial.explorers.empty()) all.insert(trial.explorers);
  }
  return all.empty() ? kNone : fmt::format("{}", fmt::join(all, "; "));
}

/// The paper's table, its figures beside ours.
TextTable SideBySide(const std::vector<TrialGroup>& groups) {
  TextTable table;
  table.header = {"Scenario",   "N_a",    "Preset",  "Found by", "Graph (s)",
                  "Motion (s)", "\u03b3", "Success", "Verified", "Paper: graph (s)",
                  "motion (s)", "\u03b3", "success"};
  for (const TrialGroup& group : groups) {
    const TableRow* row = Find(group.row);
    if (row == nullptr) continue;
    const auto ours = [&](const char* name) {
      return MeanAndStd(group.Summary(MetricNamed(name)));
    };
    const double count = static_cast<double>(group.trials.size());
    table.rows.push_back(
        {row->title, fmt::format("{}", row->actions.size()), group.preset, ExplorersOf(group),
         ours("graph_s"), ours("motion_s"), ours("real_time_ratio"),
         Percent(group.successes() / count), Percent(group.verified() / count), Printed(row->graph),
         Printed(row->motion), Printed(row->real_time_ratio), Percent(row->success)});
  }
  return table;
}

/// All measurements, one row per group and metric.
TextTable Distributions(const std::vector<TrialGroup>& groups) {
  TextTable table;
  table.header = {"Row", "Preset", "Figure", "mean (std)", "median", "p95", "max"};
  table.text_columns = 3;
  for (const TrialGroup& group : groups) {
    for (const TrialMetric& metric : TrialMetrics()) {
      const auto summary = group.Summary(metric);
      const std::string title =
          metric.unit.empty() ? metric.title : fmt::format("{} ({})", metric.title, metric.unit);
      if (!summary) {
        table.rows.push_back({group.row, group.preset, title, kNone, kNone, kNone, kNone});
        continue;
      }
      table.rows.push_back({group.row, group.preset, title, MeanAndStd(summary),
                            Number(summary->median), Number(summary->p95), Number(summary->max)});
    }
  }
  return table;
}

double AnswerSeconds(const TrialRecord& record) {
  return record.timings.preparation_s + record.timings.graph_s;
}

std::string AnswersOf(const TrialGroup& group) {
  const std::string text = group.AnswersText();
  return group.successes() == 0 ? text : fmt::format("{}; {} PLANS", text, group.successes());
}

SampleSummary AnswerTimes(const TrialGroup& group) {
  std::vector<double> seconds;
  for (const TrialRecord& record : group.trials) seconds.push_back(AnswerSeconds(record));
  return Summarise(seconds);
}

TextTable Twins(const std::vector<TrialGroup>& groups) {
  TextTable table;
  table.header = {"Scenario", "Answers", "Trials", "Time: mean (std) (s)", "median", "p95", "max"};
  table.text_columns = 2;
  for (const TrialGroup& group : groups) {
    const SampleSummary seconds = AnswerTimes(group);
    table.rows.push_back({group.row, AnswersOf(group), fmt::format("{}", group.trials.size()),
                          MeanAndStd(seconds), Number(seconds.median), Number(seconds.p95),
                          Number(seconds.max)});
  }
  return table;
}

/// Notes that a reader needs before comparing.
std::vector<std::string> Notes(const std::vector<TrialRecord>& trials) {
  return {
      fmt::format("Measured on: {}. One thread per trial. Printed figures: {}.",
                  trials.empty() ? ThisEnvironment().cpu : MachinesOf(trials), kPaperMachine),
      "The paper published no dimensions of its scenes: those of ours are our own, so that the two "
      "sets of figures are of scenes that look alike, not of the same ones.",
      "Figures are of the trials that found a plan. Graph includes confirmation. \u03b3 is the "
      "plan's duration over preparation, graph and motion; the paper's is over graph and motion. "
      "Verification is reported beside it. Std is that of a sample; p95 is by nearest rank."};
}

constexpr const char* kTwinsNote =
    "Scenarios without a way through. Time: preparation and search, until the answer.";

struct NamedPicture {
  std::string file;
  std::string caption;
  std::string svg;
};

std::vector<NamedPicture> Pictures(const std::vector<TrialGroup>& groups) {
  return {{"graph_distribution.svg", "Graph time, confirmation included",
           SvgDocument({DistributionPlot(groups, MetricNamed("graph_s"))})},
          {"motion_distribution.svg", "Motion generation",
           SvgDocument({DistributionPlot(groups, MetricNamed("motion_s"))})},
          {"success.svg", "Success against time", SvgDocument({SuccessPlot(groups)})},
          {"time_shares.svg", "Where the time goes", TimeSharesPicture(groups)}};
}

PageSection Gallery(const std::vector<TrialGroup>& groups, const std::filesystem::path& folder) {
  PageSection gallery = PlanGallery(groups, folder);
  gallery.paragraphs = {
      "From above: obstacles dark, explored graph thin, pelvis path coloured by action (green "
      "walk, "
      "light blue crawl, fuchsia jump, orange transitions)."};
  return gallery;
}

}  // namespace

std::vector<std::string> TableRowOrder() {
  std::vector<std::string> names;
  for (const TableRow& row : TableRows()) names.push_back(row.name);
  names.insert(names.end(), InfeasibleTwins().begin(), InfeasibleTwins().end());
  return names;
}

Json TableReport::Summary() const {
  Json json;
  json["format"] = "possibility-table/1";
  json["machine"] = MachinesOf(trials.empty() ? twins : trials);
  json["rows"] = Json::array();
  for (const TrialGroup& group : GroupTrials(trials)) {
    Json entry = group.Json();
    if (const TableRow* row = Find(group.row)) {
      entry["scenario"] = row->scenario;
      entry["actions"] = row->actions;
      entry["paper"] = {{"graph_s", {{"mean", row->graph.mean}, {"std", row->graph.std}}},
                        {"motion_s", {{"mean", row->motion.mean}, {"std", row->motion.std}}},
                        {"real_time_ratio",
                         {{"mean", row->real_time_ratio.mean}, {"std", row->real_time_ratio.std}}},
                        {"success", row->success}};
    }
    json["rows"].push_back(std::move(entry));
  }
  if (twins.empty()) return json;
  json["twins"] = Json::array();
  for (const TrialGroup& group : GroupTrials(twins)) {
    json["twins"].push_back({{"scenario", group.row},
                             {"trials", group.trials.size()},
                             {"plans", group.successes()},
                             {"no", group.answers()},
                             {"answer_s", ToJson(AnswerTimes(group))}});
  }
  return json;
}

std::string TableReport::Markdown() const {
  std::string text = "# Table 1, side by side\n\n";
  for (const std::string& note : Notes(trials)) text += note + "\n\n";
  const std::vector<TrialGroup> groups = GroupTrials(trials);
  text += SideBySide(groups).Markdown();
  text += "\n## Distributions\n\n" + Distributions(groups).Markdown();
  if (twins.empty()) return text;
  return text + "\n## Infeasible twins\n\n" + kTwinsNote + "\n\n" +
         Twins(GroupTrials(twins)).Markdown();
}

void TableReport::Write(const std::filesystem::path& folder) const {
  const std::vector<TrialGroup> groups = GroupTrials(trials);
  WriteOutput(folder / "summary.json", models::JsonText(Summary(), 2) + "\n");
  WriteOutput(folder / "table.md", Markdown());
  std::vector<PageSection> sections = {
      {"Ours and the paper's", Notes(trials), SideBySide(groups).Html(), {}, false}};
  PageSection plots{"Times", {}, "", {}, false};
  for (const NamedPicture& picture : Pictures(groups)) {
    WriteOutput(folder / picture.file, picture.svg);
    plots.figures.push_back({picture.caption, picture.svg});
  }
  sections.push_back(std::move(plots));
  sections.push_back(Gallery(groups, folder));
  sections.push_back({"Distributions", {}, Distributions(groups).Html(), {}, false});
  if (!twins.empty()) {
    PageSection gallery = PlanGallery(GroupTrials(twins), folder);
    sections.push_back({"Infeasible twins",
                        {kTwinsNote},
                        Twins(GroupTrials(twins)).Html(),
                        std::move(gallery.figures),
                        true});
  }
  WriteOutput(folder / "report.html", ExperimentPage("Table 1, side by side", sections));
}

}  // namespace possibility::experiments
